"""What a speaking mouth must do, measured on the face's skin frame by frame while it speaks known sentences."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.parameters import PARAMETERS, indices_of
from agentface.speech.phones import Phone
from agentface.studies.harvard import Sentence, harvard
from agentface.studies.mouth_ruler import MouthMeasures, MouthRuler

HZ = 60
FRAME_S = 1.0 / HZ
SHUT_MM, BITTEN_MM = 0.3, 0.5
LIPS_SHUT, LIP_BITTEN = ("p", "b", "m"), ("f", "v")
OPEN_VOWELS = ("aa", "ae", "ah", "ao")
_FINER = 12
"""So many times within each p, b and m the gap is looked at, to tell how long it is shut."""
_EVEN = 500
_LAG_S, _LONG_S = 0.06, 0.07
_LEAD_S, _REST_S, _SILENCE_S = 0.3, 0.2, 1.0


class Bound(NamedTuple):
    """A law: the figure's least and largest value."""

    least: float
    most: float


LAWS: Mapping[str, Bound] = {
    "gap_in_pbm_mm": Bound(0.0, SHUT_MM),
    "shut_least": Bound(0.5, 0.9),
    "shut_most": Bound(0.5, 0.9),
    "lip_to_teeth_in_fv_mm": Bound(0.0, BITTEN_MM),
    "gap_in_aa_mm": Bound(6.0, np.inf),
    "jaw_in_s_mm": Bound(-np.inf, 2.5),
    "jaw_aa_over_ih_mm": Bound(0.0, np.inf),
    "width_iy_over_uw_mm": Bound(0.0, np.inf),
    "width_in_uw_mm": Bound(-np.inf, 0.0),
    "protrusion_in_uw_mm": Bound(0.0, np.inf),
    "lag_frames": Bound(-1.0, 1.0),
    "lip_speed_mm_s": Bound(0.0, 450.0),
    "smile_kept": Bound(0.75, np.inf),
    "upper_face_moved": Bound(0.0, 0.05),
}
"""What holds for every emotion, rate and loudness; ``smile_kept`` where there is a smile."""
STATES: tuple[dict[str, float], ...] = (
    {},
    *({name: 1.0} for name in EMOTIONS),
    *(dict.fromkeys(pair, 1.0) for pair in combinations(EMOTIONS, 2)),
)
"""No emotion, each at full strength, and each two."""
_UPPER = [
    known.index for known in PARAMETERS if known.group in ("brow", "eyes") or known.name.startswith("orbicularis_oculi")
]
_SMILE = list(indices_of("zygomaticus_major"))


@dataclass(frozen=True, slots=True)
class Manner:
    """How the sentences are said."""

    state: Mapping[str, float]
    rate: float = 1.0
    loudness: float = 1.0

    def __str__(self) -> str:
        return f"{'+'.join(self.state) or 'neutral'}, rate {self.rate:g}, loudness {self.loudness:g}"


class SpeakingMouth:
    """A face that says sentences, and what is measured of it."""

    def __init__(self, model: HeadModel, deformer: str) -> None:
        self._face = Face(model, deformer=deformer)
        self._ruler = MouthRuler(model)
        ring = model.lips.rings[0]
        self._lips = np.array([*ring.upper, *ring.lower])

    def figures(self, manner: Manner, sentences: Sequence[Sentence] | None = None) -> dict[str, float]:
        """The figures of ``LAWS`` over sentences; ``smile_kept`` is left out where nothing smiles."""
        notes = _Notes()
        for sentence in harvard() if sentences is None else sentences:
            self._say(sentence, manner, notes)
        return notes.figures()

    def _say(self, sentence: Sentence, manner: Manner, notes: _Notes) -> None:
        face = self._face
        face.hush()
        face.set_emotion(manner.state, fade=0.0)
        face.step(_SILENCE_S)
        silent = face.pose.array.astype(np.float64)
        face.speak(sentence.phones, start=_LEAD_S, rate=manner.rate, loudness=manner.loudness, alphabet="arpabet")
        phones = [
            Phone(p.symbol, _LEAD_S + p.start_s / manner.rate, _LEAD_S + p.end_s / manner.rate) for p in sentence.phones
        ]
        times, regular = _times(phones)
        wanted = _bitten(phones, times)
        rows, poses, lips, now = [], [], [], 0.0
        for time, bite in zip(times, wanted, strict=True):
            geometry = face.step(time - now)
            now = time
            rows.append(self._ruler.measure(geometry, bite=bool(bite)))
            poses.append(face.pose.array)
            lips.append(1000.0 * geometry.vertices[self._lips].astype(np.float64))
        columns = dict(zip(MouthMeasures._fields, np.array(rows, np.float64).T, strict=True))
        notes.add(phones, times, regular, columns, np.array(poses, np.float64), np.array(lips), silent)


class _Notes:
    """What is noted sentence by sentence."""

    def __init__(self) -> None:
        self._worst: dict[str, list[float]] = {name: [] for name in ("gap", "shut", "bite", "speed", "smile", "upper")}
        self._lags: list[float] = []
        self._at: dict[tuple[str, str], list[float]] = {}

    def add(
        self,
        phones: Sequence[Phone],
        times: Doubles,
        regular: Doubles,
        columns: Mapping[str, Doubles],
        poses: Doubles,
        lips: Doubles,
        silent: Doubles,
    ) -> None:
        """One sentence: measures and poses at ``times``; ``regular``, which of these are frames."""
        frames = regular.astype(bool)
        for phone in phones:
            inside = (times >= phone.start_s - 1e-9) & (times <= phone.end_s + 1e-9)
            widened = frames & (times >= phone.start_s - FRAME_S) & (times <= phone.end_s + FRAME_S)
            if phone.symbol in LIPS_SHUT:
                self._worst["gap"].append(columns["gap"][widened].min())
                self._worst["shut"].append(_share(times[inside], columns["gap"][inside]))
            if phone.symbol in LIP_BITTEN:
                self._worst["bite"].append(np.nanmin(columns["bite"][widened]))
            if phone.symbol in OPEN_VOWELS and phone.duration_s > _LONG_S:
                self._lags.append(_lag(phone, times[frames], columns["jaw"][frames]))
            for name in ("gap", "jaw", "width", "protrusion"):
                if (inside & frames).any():
                    self._at.setdefault((phone.symbol, name), []).extend(columns[name][inside & frames])
        talking = frames & (times > phones[0].end_s) & (times < phones[-1].start_s)
        if silent[_SMILE].mean() > 0.0:
            self._worst["smile"].append(poses[talking][:, _SMILE].mean() / silent[_SMILE].mean())
        self._worst["upper"].append(np.abs(poses[:, _UPPER] - silent[_UPPER]).max())
        moves = np.linalg.norm(np.diff(lips[frames], axis=0), axis=2)
        self._worst["speed"].append(moves.max() / FRAME_S)

    def figures(self) -> dict[str, float]:
        """Over all sentences."""
        worst, at = self._worst, {key: float(np.mean(values)) for key, values in self._at.items()}

        def mean(phone: str, name: str) -> float:
            return at.get((phone, name), np.nan)

        figures = {
            "gap_in_pbm_mm": max(worst["gap"], default=np.nan),
            "shut_least": min(worst["shut"], default=np.nan),
            "shut_most": max(worst["shut"], default=np.nan),
            "lip_to_teeth_in_fv_mm": max(worst["bite"], default=np.nan),
            "gap_in_aa_mm": mean("aa", "gap"),
            "jaw_in_s_mm": mean("s", "jaw"),
            "jaw_aa_over_ih_mm": mean("aa", "jaw") - mean("ih", "jaw"),
            "width_iy_over_uw_mm": mean("iy", "width") - mean("uw", "width"),
            "width_in_uw_mm": mean("uw", "width"),
            "protrusion_in_uw_mm": mean("uw", "protrusion"),
            "lag_frames": float(np.median(self._lags)) / FRAME_S if self._lags else np.nan,
            "lip_speed_mm_s": max(worst["speed"]),
            "smile_kept": min(worst["smile"], default=np.nan),
            "upper_face_moved": max(worst["upper"]),
        }
        return {name: float(value) for name, value in figures.items() if np.isfinite(value)}


def broken(figures: Mapping[str, float]) -> list[str]:
    """The laws that figures break, in words."""
    return [
        f"{name}: {value:.3g} is not in {LAWS[name].least:g}..{LAWS[name].most:g}"
        for name, value in figures.items()
        if not LAWS[name].least <= value <= LAWS[name].most
    ]


def _times(phones: Sequence[Phone]) -> tuple[Doubles, Doubles]:
    """Frames, and finer times within p, b and m; and which are frames."""
    frames = np.arange(0.0, phones[-1].end_s + _REST_S, FRAME_S)
    finer = [np.linspace(phone.start_s, phone.end_s, _FINER) for phone in phones if phone.symbol in LIPS_SHUT]
    times = np.concatenate([frames, *finer])
    order = np.argsort(times, kind="stable")
    regular = np.concatenate([np.ones(len(frames)), np.zeros(len(times) - len(frames))])
    return times[order], regular[order]


def _bitten(phones: Iterable[Phone], times: Doubles) -> Doubles:
    """Which times lie in an f or v, widened by a frame."""
    inside = np.zeros(len(times))
    for phone in phones:
        if phone.symbol in LIP_BITTEN:
            inside[(times >= phone.start_s - FRAME_S) & (times <= phone.end_s + FRAME_S)] = 1.0
    return inside


def _share(times: Doubles, gaps: Doubles) -> float:
    """For how much of the times the lips are shut, as the gap goes straight from one to the next."""
    even = np.linspace(times[0], times[-1], _EVEN)
    return float((np.interp(even, times, gaps) <= SHUT_MM).mean())


def _lag(phone: Phone, times: Doubles, jaw: Doubles) -> float:
    """s, by which the jaw is widest after a vowel's middle."""
    near = np.flatnonzero((times >= phone.start_s - _LAG_S) & (times <= phone.end_s + _LAG_S))
    return float(times[near[jaw[near].argmax()]] - 0.5 * (phone.start_s + phone.end_s))
