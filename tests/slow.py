"""Which tests ``make quick`` leaves out besides those that are marked ``slow`` where they stand: ``slow.txt``."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

FILE = Path(__file__).with_name("slow.txt")
ONE_S, ALL_S, READY_S = 0.15, 0.5, 1.5
"""From how long on a function of tests is slow: one of its tests, all of them; and a module, in getting ready."""
_HEAD = """\
# Functions and whole modules of tests that `make quick` leaves out, as long as they took on one machine; written by
# `pytest --note-slow`.
"""


@dataclass(frozen=True)
class SlowTests:
    """``names``: of modules, and of functions in them as pytest writes them."""

    names: frozenset[str]

    @classmethod
    def noted(cls) -> SlowTests:
        """Those of ``slow.txt``."""
        lines = FILE.read_text().splitlines()
        return cls(frozenset(line for line in lines if line and not line.startswith("#")))

    @classmethod
    def measured(cls, reports: Iterable[tuple[str, str, float]], noted: SlowTests) -> SlowTests:
        """By the node, the phase (``setup``, ``call``, ``teardown``) and the seconds of each report.

        What was ``noted`` of modules of which nothing is reported stays.
        """
        longest, together, ready = defaultdict(float), defaultdict(float), defaultdict(float)
        for node, phase, seconds in reports:
            module, function = _module(node), _function(node)
            if phase == "call":
                longest[function] = max(longest[function], seconds)
                together[function] += seconds
            elif phase == "setup":
                ready[module] += seconds
        modules = {module for module, seconds in ready.items() if seconds >= READY_S}
        slow = {function for function in longest if longest[function] >= ONE_S or together[function] >= ALL_S}
        others = {name for name in noted.names if _module(name) not in ready}
        return cls(frozenset(modules | others | {function for function in slow if _module(function) not in modules}))

    def has(self, node: str) -> bool:
        """Whether the test is one of them."""
        return _module(node) in self.names or _function(node) in self.names

    def note(self) -> None:
        """Write ``slow.txt``."""
        FILE.write_text(_HEAD + "".join(f"{name}\n" for name in sorted(self.names)))


def _module(node: str) -> str:
    return node.partition("::")[0]


def _function(node: str) -> str:
    return node.partition("[")[0]
