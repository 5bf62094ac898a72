"""What is kept between runs: never stale, never half, and never needed."""

from __future__ import annotations

import os

import pytest

from agentface import cache


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache of its own."""
    monkeypatch.setattr(cache, "_prepared_folder", lambda: tmp_path)
    return tmp_path


def counted():
    calls = []

    def make():
        calls.append(1)
        return {"number": len(calls)}

    return make, calls


def test_an_entry_is_made_once_a_stamp(folder):
    make, calls = counted()
    assert cache.prepared("a", "x", make) == {"number": 1}
    assert cache.prepared("a", "x", make) == {"number": 1}
    assert cache.prepared("b", "x", make) == {"number": 2}
    assert cache.prepared("a", "y", make) == {"number": 3}
    assert len(calls) == 3
    assert sorted(path.name for path in folder.iterdir()) == ["a-x", "a-y", "b-x"]


@pytest.mark.parametrize("damage", [b"", b"\x80\x05", b"nonsense", b"\x80\x05cno.such.module\nThing\n."])
def test_a_damaged_entry_is_made_anew(folder, damage):
    make, calls = counted()
    (folder / "a-x").write_bytes(damage)
    assert cache.prepared("a", "x", make) == {"number": 1}
    assert cache.prepared("a", "x", make) == {"number": 1}
    assert len(calls) == 1


def test_a_full_disk_leaves_nothing_half_and_is_told_once(folder, monkeypatch, caplog):
    def full(content, file, protocol):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache, "_told", set())
    monkeypatch.setattr("pickle.dump", full)
    make, _ = counted()
    for number in (1, 2):
        assert cache.prepared("a", "x", make) == {"number": number}
    assert list(folder.iterdir()) == []
    assert [record.message.count("No space left") for record in caplog.records] == [1]


def test_without_a_folder_everything_is_made_anew(monkeypatch):
    monkeypatch.setattr(cache, "_prepared_folder", lambda: None)
    make, _ = counted()
    assert [cache.prepared("a", "x", make)["number"] for _ in range(2)] == [1, 2]


def test_a_stamp_changes_with_every_file_and_word(tmp_path):
    files = [tmp_path / name for name in ("one", "two")]
    for file in files:
        file.write_text("a")
    stamps = {cache.stamp_of(files), cache.stamp_of(files, "more"), cache.stamp_of(files[:1])}
    os.utime(files[1], ns=(1, 1))
    stamps.add(cache.stamp_of(files))
    files[0].write_text("ab")
    stamps.add(cache.stamp_of(files))
    assert len(stamps) == 5
    assert cache.stamp_of(files) in stamps


def test_only_the_newest_are_kept(tmp_path):
    for age in range(5):
        entry = tmp_path / f"{age}"
        if age % 2:
            entry.mkdir()
        else:
            entry.write_text("")
        os.utime(entry, (1000 - age, 1000 - age))
    cache.keep_newest(tmp_path, 3)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0", "1", "2"]


def test_what_was_used_last_is_kept(folder, monkeypatch):
    monkeypatch.setattr(cache, "_ENTRIES", 2)
    make, calls = counted()
    for age, stamp in enumerate(("b", "a")):
        cache.prepared(stamp, "x", make)
        os.utime(folder / f"{stamp}-x", (1000 - age, 1000 - age))
    cache.prepared("a", "x", make)
    cache.prepared("c", "x", make)
    assert sorted(path.name for path in folder.iterdir()) == ["a-x", "c-x"]
    assert len(calls) == 3
