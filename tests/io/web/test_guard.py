"""Who may ask a web server, and how much."""

from __future__ import annotations

import asyncio
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.io.web.access import Access, check_origin, is_loopback, split_authority
from agentface.io.web.guard import REQUESTS_AT_ONCE, Guard, guarded
from tests.clocks import ManualClock


def scope(path="/status", method="GET", kind="http", client="10.0.0.9", query=b"", **headers):
    rows = [(name.replace("_", "-").encode(), value.encode("latin-1")) for name, value in headers.items()]
    return {
        "type": kind, "path": path, "method": method, "query_string": query, "headers": rows, "client": (client, 5),
        "scheme": "http", "extensions": {"websocket.http.response": {}}, "http_version": "1.1",
    }  # fmt: skip


async def reads_all(scope, receive, send):
    while (await receive()).get("more_body"):
        pass
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"well"})


def answer(app, asked, *bodies):
    """Status, headers and body that an application answers."""
    sent, waiting = (
        [],
        [{"type": "http.request", "body": b, "more_body": n + 1 < len(bodies)} for n, b in enumerate(bodies)],
    )

    async def receive():
        return waiting.pop(0) if waiting else {"type": "http.request", "body": b""}

    async def send(message):
        sent.append(message)

    asyncio.run(app(asked, receive, send))
    start = next(message for message in sent if message["type"].endswith("response.start"))
    body = b"".join(message.get("body", b"") for message in sent if message["type"].endswith("response.body"))
    return start["status"], {name.decode().lower(): value.decode() for name, value in start["headers"]}, body


def status(access, asked, **options):
    return answer(guarded(reads_all, access, **options), asked, b"")[0]


LOCAL = Access.of("127.0.0.1")


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8080", "localhost", "LOCALHOST:1", "[::1]:8080", "127.8.8.8", "localhost.:80", "a.localhost:3"]
)
def test_a_loopback_server_knows_its_names(host):
    assert status(LOCAL, scope(host=host)) == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example", "0.0.0.0:8080",
     "10.0.0.1", "", "127.0.0.1:99999", "a b", "[::1", "localhost:80:80", "user@localhost", "localhost/x"],
)  # fmt: skip
def test_another_host_is_refused(host):
    assert status(LOCAL, scope(host=host)) == 403


def test_one_host_is_needed():
    asked = scope()
    assert status(LOCAL, asked) == 403
    asked["headers"] = [(b"host", b"localhost"), (b"host", b"evil.example")]
    assert status(LOCAL, asked) == 403
    asked["headers"] = [(b"host", b"localhost"), (b"origin", b"http://localhost"), (b"origin", b"http://evil.example")]
    assert status(LOCAL, asked) == 403


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "http://localhost:3000", "http://127.0.0.1:8081", "https://127.0.0.1:80801", "file://",
     "http://localhost:8080", "http://127.0.0.1:8080.evil.example", "127.0.0.1:8080", "chrome-extension://abc", "*",
     "http://127.0.0.1:8080/x", "http://user@127.0.0.1:8080", "http://127.0.0.1:8080 http://evil.example"],
)  # fmt: skip
def test_a_foreign_origin_is_refused_on_loopback_too(origin, kind):
    code, headers, body = answer(
        guarded(reads_all, LOCAL), scope(kind=kind, method="POST", host="127.0.0.1:8080", origin=origin), b""
    )
    assert code == 403
    assert "access-control-allow-origin" not in headers
    assert json.loads(body)["error"]["where"] == "Origin"
    assert "--allow-origin" in json.loads(body)["error"]["hint"]


def test_own_pages_may_ask():
    assert status(LOCAL, scope(method="POST", host="127.0.0.1:8080", origin="http://127.0.0.1:8080")) == 200
    assert status(LOCAL, scope(host="localhost", origin="http://localhost")) == 200
    assert status(LOCAL, scope(host="localhost:80", origin="http://localhost")) == 200
    assert status(LOCAL, scope(host="[::1]:8080", origin="http://[::1]:8080")) == 200


def test_an_allowed_site_may_ask_and_read():
    access = Access.of("127.0.0.1", ["https://Faces.example/"])
    asked = scope(method="POST", host="127.0.0.1:8080", origin="https://faces.example")
    code, headers, _ = answer(guarded(reads_all, access), asked, b"{}")
    assert code == 200
    assert headers["access-control-allow-origin"] == "https://faces.example"
    assert status(access, scope(host="faces.example", origin="https://faces.example")) == 200, "behind a proxy"
    for other in (
        "http://faces.example",
        "https://faces.example:8443",
        "https://x.faces.example",
        "https://faces.examplex",
    ):
        assert status(access, scope(host="127.0.0.1:8080", origin=other)) == 403


def test_a_browser_may_ask_first():
    access = Access.of("0.0.0.0", ["https://faces.example"], "correct-horse")  # noqa: S104
    asked = scope(
        method="OPTIONS", host="10.0.0.1", origin="https://faces.example", access_control_request_method="POST",
        access_control_request_headers="authorization,content-type", access_control_request_private_network="true",
    )  # fmt: skip
    code, headers, _ = answer(guarded(reads_all, access), asked, b"")
    assert code == 200
    assert headers["access-control-allow-origin"] == "https://faces.example"
    assert "authorization" in headers["access-control-allow-headers"].lower()
    assert headers["access-control-allow-private-network"] == "true"
    asked = scope(
        method="OPTIONS", host="10.0.0.1", origin="https://evil.example", access_control_request_method="POST"
    )
    assert status(access, asked) == 403


def test_a_browser_that_hides_the_origin_changes_nothing():
    assert status(LOCAL, scope(method="POST", host="localhost", sec_fetch_site="cross-site")) == 403
    assert status(LOCAL, scope(kind="websocket", host="localhost", sec_fetch_site="cross-site")) == 403
    assert status(LOCAL, scope(host="localhost", sec_fetch_site="cross-site")) == 200, "a link to the page"


def test_beyond_the_loopback_there_is_a_token():
    assert LOCAL.token is None
    access = Access.of("0.0.0.0")  # noqa: S104
    assert access.token
    assert access.token != Access.of("0.0.0.0").token  # noqa: S104
    for host in ("10.1.2.3:8080", "[2001:db8::1]:80", "localhost:8080", f"{next(iter(access.names))}:80"):
        assert status(access, scope(host=host)) == 401
        assert status(access, scope(host=host, authorization=f"Bearer {access.token}")) == 200
    assert status(access, scope(host="evil.example", authorization=f"Bearer {access.token}")) == 403


@pytest.mark.parametrize(
    "shown", ["", "Bearer", "Bearer wrong", "Basic right-right-right", "Bearer right-right-righ", "Bearer ü"]
)
def test_a_wrong_token_is_refused(shown):
    access = Access.of("127.0.0.1", token="right-right-right")  # noqa: S106
    code, headers, _ = answer(guarded(reads_all, access), scope(host="localhost", authorization=shown), b"")
    assert (code, headers["www-authenticate"]) == (401, "Bearer")
    assert status(access, scope(host="localhost", authorization="bearer right-right-right")) == 200
    assert status(access, scope(host="localhost", query=b"a=1&token=right-right-right")) == 200
    assert status(access, scope(host="localhost", query=b"token=right-right-wrong")) == 401
    assert status(access, scope("/", host="localhost"), open_paths=("/",)) == 200
    assert status(access, scope("/x", host="localhost"), open_paths=("/",)) == 401


@pytest.mark.parametrize("token", ["short", "x" * 300, "has blanks in it", "ümlautümlaut", "a\nb-long-enough"])
def test_a_token_is_hard_to_guess(token):
    with pytest.raises(InvalidValueError):
        Access.of("127.0.0.1", token=token)


def test_the_size_is_bounded():
    asked = scope(method="POST", host="localhost", content_length="101")
    assert status(LOCAL, asked, largest_body=100) == 413
    assert status(LOCAL, scope(method="POST", host="localhost", content_length="-1")) == 413
    app, asked = guarded(reads_all, LOCAL, largest_body=100), scope(method="POST", host="localhost")
    assert answer(app, asked, b"x" * 60, b"x" * 60)[0] == 413, "whatever the request says of itself"
    assert answer(app, asked, b"x" * 60, b"x" * 40)[0] == 200
    assert status(LOCAL, scope(host="localhost", query=b"a" * 5000)) == 414


def test_the_rate_of_each_address_is_bounded():
    clock = ManualClock()
    guard = Guard(reads_all, LOCAL, clock=clock)
    asked = scope(host="localhost", client="10.0.0.1")
    for _ in range(int(REQUESTS_AT_ONCE)):
        assert guard.refusal(asked) is None
    assert guard.refusal(asked).status == 429
    assert guard.refusal(scope(host="localhost", client="10.0.0.2")) is None
    clock.sleep(1.0)
    assert guard.refusal(asked) is None


def test_many_addresses_cost_no_memory():
    guard = Guard(reads_all, LOCAL, clock=ManualClock())
    for number in range(3000):
        guard.refusal(scope(host="localhost", client=f"10.0.{number // 256}.{number % 256}"))
    assert len(guard._rates) <= 1024


def test_what_is_open_is_told():
    assert "programs on this machine" in LOCAL.told("the page")[0]
    access = Access.of("0.0.0.0", ["https://faces.example"])  # noqa: S104
    (line,) = access.told("the page")
    assert access.token in line
    assert "https://faces.example" in line
    assert "every machine" in line


@pytest.mark.parametrize(
    "origin", ["*", "example.org", "ftp://a.b", "https://", "https://a b", "https://a/b", "null", "https://ä.example"]
)
def test_an_origin_is_a_site(origin):
    with pytest.raises(InvalidValueError):
        check_origin(origin)


def test_an_origin_has_one_spelling():
    assert check_origin("HTTPS://Example.ORG:443/") == "https://example.org"
    assert check_origin("http://[::1]:80") == "http://[::1]"
    assert check_origin("http://a:8080") == "http://a:8080"


def test_loopback():
    assert all(map(is_loopback, ("localhost", "127.0.0.1", "127.1.1.1", "::1", "[::1]", "::ffff:127.0.0.1")))
    assert not any(map(is_loopback, ("0.0.0.0", "::", "10.0.0.1", "example.org", "localhost.example.org", "")))  # noqa: S104


@given(st.text(max_size=60), st.text(max_size=60))
def test_no_host_or_origin_disturbs_it(host, origin):
    split_authority(host)
    LOCAL.knows_host(host)
    assert LOCAL.knows_origin(origin, host) in (True, False)
    assert not LOCAL.knows_token("") or LOCAL.token is None
