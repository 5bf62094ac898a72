"""Phones laid out in time as segments, each with its target and its dominance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from agentface.conventions import Doubles
from agentface.speech.alphabets import Looks, Part
from agentface.speech.articulation import Articulation, Timeline
from agentface.speech.phones import Phone

SILENCE = Part((("sil", 1.0),), 0.0, 1.0, 1.0)
AROUND_S = 4.0
"""So much silence is before and after all that is said."""
_SHORTEST_S = 1e-3
_BEFORE, _AFTER = 3, 1
"""Of how many sounds before and after one the rate is taken: what comes later is not known yet when speech is live."""
_HELD = 0.1, 0.65
"""From when to when of a sound the jaw is held."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A part of a sound in time: what it shows, from ``start`` to ``end`` in s, at which local rate."""

    part: Part
    start: float
    end: float
    rate: float

    @property
    def silent(self) -> bool:
        """Whether nothing is said."""
        return self.part.visemes == SILENCE.visemes


def segments_of(phones: Sequence[Phone], looks: Sequence[Looks], normal_s: float) -> list[Segment]:
    """The segments of ``phones``, with silence in every gap, before and after; ``normal_s``: a sound at rate 1."""
    if not phones:
        return []
    rates = _rates(phones, [look[0].visemes == SILENCE.visemes for look in looks], normal_s)
    end = phones[0].start_s - AROUND_S
    found: list[Segment] = []
    for phone, look, rate in zip(phones, looks, rates, strict=True):
        if phone.start_s - end > _SHORTEST_S:
            found.append(Segment(SILENCE, end, phone.start_s, 1.0))
        end = max(phone.end_s, end)
        if phone.duration_s < _SHORTEST_S:
            continue
        for part in look:
            start, stop = (phone.start_s + cut * phone.duration_s for cut in (part.start, part.end))
            found.append(Segment(part, start, stop, rate))
    return [*found, Segment(SILENCE, end, end + AROUND_S, 1.0)]


def _rates(phones: Sequence[Phone], silent: Sequence[bool], normal_s: float) -> list[float]:
    """How fast is spoken at each phone, against phones of ``normal_s``; a pause parts what is before and after it."""
    parted = [
        silent[place] or silent[place + 1] or after.start_s - phone.end_s > _SHORTEST_S
        for place, (phone, after) in enumerate(pairwise(phones))
    ]
    rates = []
    for here in range(len(phones)):
        first = last = here
        while first > max(0, here - _BEFORE) and not parted[first - 1]:
            first -= 1
        while last < min(len(phones) - 1, here + _AFTER) and not parted[last]:
            last += 1
        near = [phone.duration_s for phone in phones[first : last + 1]]
        rates.append(1.0 if silent[here] else normal_s * len(near) / max(sum(near), _SHORTEST_S))
    return rates


def timeline_of(segments: Sequence[Segment], articulation: Articulation, loudness: float = 1.0) -> Timeline:
    """Segments as arrays."""
    rules = articulation.rules
    spans = np.array([(segment.start, segment.end) for segment in segments]).reshape(-1, 2)
    lengths = spans[:, 1] - spans[:, 0]
    early = np.array([articulation.early_s(segment.part) for segment in segments])
    middle = spans.mean(axis=1) - early
    flat = np.maximum(rules.middle * lengths, 0.5 * lengths - rules.edge_s)
    rates = np.clip([segment.rate for segment in segments], rules.rate.least, rules.rate.most)
    dominance = np.array([articulation.dominance(segment.part) for segment in segments])
    dominance = dominance.reshape(-1, len(articulation.articulators), 3)
    dominance[:, :, 1:] *= np.sqrt(rates)[:, None, None]
    targets = np.array([articulation.target(segment.part) for segment in segments])
    targets = targets.reshape(-1, len(articulation.names)) * _gains(articulation, rates, loudness)
    tight = np.array([articulation.tight(segment.part) for segment in segments])
    said = np.array([float(not segment.silent) for segment in segments])
    kept = spans[:, :1] + np.array(_HELD) * lengths[:, None]
    held = _held(articulation, spans, rates)
    return Timeline(spans, np.column_stack([middle, flat]), np.clip(targets, -1, 1), dominance, held, tight, kept, said)


def _gains(articulation: Articulation, rates: Doubles, loudness: float) -> Doubles:
    """``(S, P)``: what rate and loudness make of each target."""
    rules = articulation.rules
    loud = np.array([1.0 + rules.loudness.get(name, 0.0) * (loudness - 1.0) for name in articulation.articulators])
    gains = np.ones((len(rates), len(articulation.names)))
    moved = len(articulation.names) - len(articulation.contacts)
    gains[:, :moved] = loud[articulation.ramps.articulator]
    gains[:, articulation.jaw] *= np.clip(rates**rules.rate.jaw_power, rules.rate.jaw_least, rules.rate.jaw_most)
    return gains


def _held(articulation: Articulation, spans: Doubles, rates: Doubles) -> Doubles:
    """``(S, C, 4)`` s: from when to when each contact is whole, and how long it comes and goes."""
    lengths, quick = spans[:, 1] - spans[:, 0], rates**articulation.rules.rate.contact_power
    held = np.zeros((len(spans), len(articulation.contacts), 4))
    for place, row in enumerate(articulation.rules.contacts.values()):
        end = spans[:, 0] + row.ends * lengths - row.part_s * quick
        held[:, place, 0] = np.minimum(spans[:, 0] + row.begins * lengths, end - row.least_s)
        held[:, place, 1] = end
        held[:, place, 2], held[:, place, 3] = row.before_s * quick, row.after_s * quick
    return held
