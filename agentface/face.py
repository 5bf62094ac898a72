""":class:`Face`: the whole engine behind a few calls."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Self

import numpy as np

from agentface.calls.expression_calls import ExpressionCalls
from agentface.calls.movement_calls import MovementCalls
from agentface.calls.speech_calls import SpeechCalls
from agentface.calls.twins import AwaitableTwins
from agentface.clock import Clock, SystemClock
from agentface.conventions import Bytes, check_duration
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import DEFAULT_DEFORMER, Deformer, make_deformer
from agentface.emotion.explanation import Explanation
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import InvalidValueError
from agentface.events.events import Events
from agentface.head.model import HeadModel, load_model
from agentface.motion.doing import Doing
from agentface.motion.gestures.table import all_gestures
from agentface.motion.mixer import Mixer
from agentface.parameters import CONTRACTIONS, HELD, MUSCLES, FacePose
from agentface.requests import Request, SetLiveliness
from agentface.resources import DEFAULT_FACE
from agentface.talk.agendas import Agendas
from agentface.talk.blocks import BlockPlayer
from agentface.talk.talker import Talker

if TYPE_CHECKING:
    from agentface.view.renderer import Renderer


@dataclass(slots=True)
class MessageCounts:
    """Counts of the messages that came from outside: those understood, and the others by what was wrong."""

    messages: int = 0
    errors: dict[str, int] = field(default_factory=lambda: dict.fromkeys(("malformed", "unknown", "rejected"), 0))


class Face(ExpressionCalls, MovementCalls, SpeechCalls, AwaitableTwins):
    """A face that shows what it is told.

    Args:
        face: the name of a face, the path of its folder, or a model that is already loaded.
        deformer: ``geometric`` (Bui et al.), or one that a program has registered (:mod:`agentface.deform.protocol`).
        seed: of everything random in the motion; the same calls then give the same frames.
        compiled: False for numpy instead of compiled kernels: one picture is there sooner, a frame takes far longer.
        look: the name of a look of this face, or the path of its file; the face's own when None.
        asymmetry: how much of its own asymmetry the face has, 0..1; a model that is loaded has its own.
        liveliness: how much it lives between messages, 0, perfectly still, .. 1; 0.6 is natural.
        gestures: a file of gestures beside those of ``rules/gestures.yaml`` and the user's.
        clock: measures ``frame_ms``; the motion itself takes its time from ``step`` alone.

    A call changes where the face goes, ``step`` moves it there. Times are seconds; a fade of 0 is done at once.
    Every call checks its arguments first and changes nothing when it raises: UnknownNameError for a name,
    InvalidValueError for a value.

    Emotions: ``set_emotion("fear", 0.5)`` changes that emotion and leaves the others, so that several can be
    mixed one by one; ``set_emotion({"fear": 0.5})`` sets the whole state, and what it does not name goes to 0;
    ``neutral()`` clears everything but the mood.
    """

    def __init__(
        self,
        face: str | Path | HeadModel = DEFAULT_FACE,
        *,
        deformer: str = DEFAULT_DEFORMER,
        seed: int = 0,
        clock: Clock | None = None,
        compiled: bool = True,
        look: str | Path | None = None,
        asymmetry: float = 1.0,
        liveliness: float = 0.0,
        gestures: str | Path | None = None,
    ) -> None:
        self.model = face if isinstance(face, HeadModel) else load_model(face, asymmetry=asymmetry)
        self.random = np.random.default_rng(seed)
        self.message_counts = MessageCounts()
        self.noted: list[Callable[[Request], None]] = []
        """Called with every request after it was applied: who steps a face again later notes them here."""
        self.reports: dict[str, Callable[[], object]] = {}
        """What the status has beside its own, by key: links to other programs tell of themselves here, JSON-ready."""
        self._events = Events(self)
        self._clock = clock or SystemClock()
        self._inference = default_inference(compiled=compiled)
        self.channels = Mixer(
            self._inference,
            self.model.gains,
            compiled=compiled,
            random=self.random.spawn(1)[0],
            gestures=all_gestures(gestures),
        )
        self._events.follow(self.channels)
        SetLiveliness(liveliness, 0.0).apply(self)
        self._deformer = make_deformer(deformer, self.model, compiled=compiled)
        self._renderer: Renderer | None = None
        self._agendas = Agendas()
        self._look = look
        self._closed = False
        self._pose: FacePose | None = None
        self._geometry: FaceGeometry | None = None
        self._deformer.reset(self.pose)
        self._stepped: tuple[FacePose, FaceGeometry | None] = (self.pose, None)
        self._frame_ms = 0.0

    def apply(self, request: Request) -> Doing | None:
        """Do what is asked; every other way to ask something of a face ends here.

        Returns what goes on now, of what takes its time and has an end. Raises what the request raises, and then
        nothing has changed.
        """
        doing = request.apply(self)
        self._touch()
        for note in self.noted:
            note(request)
        self._events.watch(request, doing)
        return doing

    def ask(self, request: Request) -> Future[bool]:
        """Have a request applied by the next step, from any thread.

        The future has what :meth:`apply` raises, or, when it is over, whether it came to its end. To cancel it takes
        back what is not over yet.
        """
        return self._events.ask(request)

    def on(self, event: str, call: Callable[[Any], object]) -> None:
        """Call ``call``, after a step, whenever something has happened; one of ``EVENTS``, raises UnknownNameError.

        ``spoken``: a text that was said; ``hushed``: one that was cut short; ``failed``: what went wrong with one, an
        AgentFaceError; ``gestured``: a gesture's name; ``played``: a performance; ``reached``: the emotions that the
        face has come to, an EmotionState; ``blink``: how far one closes the eyes, 0..1.
        """
        self._events.on(event, call)

    def off(self, event: str, call: Callable[[Any], object]) -> None:
        """No longer call what was given to :meth:`on`."""
        self._events.off(event, call)

    def step(self, dt: float) -> FaceGeometry:
        """Let ``dt`` seconds pass, and return the face as it is then.

        The arrays of the geometry hold until this face's next step; ``copy()`` keeps them.
        """
        dt = check_duration("dt", dt)
        start = self._clock.now()
        self._events.take_in()
        self._agendas.advance(dt, self.channels.advance)
        self._touch()
        geometry = self._deformer.step(self.pose, dt)
        self._stepped = self.pose, geometry
        self._frame_ms = 1000.0 * (self._clock.now() - start)
        self._events.settle()
        return geometry

    def warm_up(self, *, solvers: bool = False) -> None:
        """Compile or load now what the first message and the first frame need, so that they are shown at once.

        With ``solvers`` that is so of the first FAP and the first of ARKit's weights, too. Takes seconds the first
        time on a machine, half a second later on. Changes nothing that is shown.
        """
        shown = Mixer(self._inference)
        shown.emotion.change({EMOTIONS[0]: 1.0}, None, None)
        shown.advance(0.1)
        self.channels.speech.warm_up()
        self._deformer.at(FacePose.of(**dict.fromkeys(MUSCLES, 1.0)))
        if solvers:
            from agentface.arkit.shape_solver import ShapeSolver
            from agentface.mpeg4.fap_solver import FapSolver
            from agentface.mpeg4.faps import FAP_COUNT

            FapSolver(self.model).solve(np.zeros(FAP_COUNT))
            ShapeSolver(self.model).solve_named({"jawOpen": 1.0})

    @property
    def talker(self) -> Talker:
        """What has texts said, and tells when each is heard."""
        if self._agendas.talker is None:
            self._agendas.talker = Talker(self)
            self.noted.append(self._agendas.talker.notice)
        return self._agendas.talker

    @property
    def blocks(self) -> BlockPlayer:
        """What plays BML blocks, and tells how far they are."""
        if self._agendas.blocks is None:
            self._agendas.blocks = BlockPlayer(self)
            self.noted.append(self._agendas.blocks.notice)
        return self._agendas.blocks

    @property
    def deformer(self) -> Deformer:
        """What makes a face of a pose."""
        return self._deformer

    def take_deformer(self, deformer: Deformer) -> None:
        """Go on with another deformer of this face, from wherever that stands."""
        self._deformer = deformer
        self._stepped = self.pose, None
        self._touch()

    @property
    def emotion(self) -> EmotionState:
        """The target intensities: what the face shows when its moves are done."""
        return self.channels.emotion.target

    @property
    def mood(self) -> EmotionState:
        """What brief expressions return to."""
        return self.channels.emotion.mood

    @property
    def held(self) -> dict[str, float]:
        """The muscles, sides apart, and the jaw that are set by hand, and the contraction that each goes to."""
        return self.channels.muscles.held

    @property
    def turned_deg(self) -> dict[str, float]:
        """Where gaze and head go: ``gaze_yaw``, ``gaze_pitch``, ``head_yaw``, ``head_roll``, ... in degrees."""
        return {
            name: round(math.degrees(angle), 6)
            for channel in (self.channels.gaze, self.channels.head)
            for name, angle in channel.targets.items()
        }

    @property
    def pose(self) -> FacePose:
        """Every animation parameter as shown now."""
        if self._pose is None:
            self._pose = self.channels.pose()
        return self._pose

    @property
    def geometry(self) -> FaceGeometry:
        """The face as shown now: as the last step left it, or at rest in a pose that was set since."""
        stepped, geometry = self._stepped
        if geometry is not None and stepped == self.pose:
            return geometry
        if self._geometry is None:
            self._geometry = self._deformer.at(self.pose)
        return self._geometry

    def render(
        self,
        size: tuple[int, int] = (1280, 720),
        camera: str = "front",
        quality: str = "fast",
        *,
        pose: FacePose | None = None,
        alpha: bool = False,
    ) -> Bytes:
        """A picture of the face as shown now: ``(height, width, 3)`` uint8, sRGB.

        Args:
            size: width and height in pixels.
            camera: ``front``, ``three-quarter`` or ``profile``.
            quality: ``fast`` or ``portrait``.
            pose: draw this pose instead, for example one kept from earlier.
            alpha: leave the background out: ``(height, width, 4)`` with straight alpha.

        Raises GraphicsError where the machine has no OpenGL, InvalidValueError after :meth:`close`.
        """
        if self._closed:
            raise InvalidValueError("Face.render", "a face that is not closed", "one after close()", "make a new Face")
        if self._renderer is None:
            from agentface.head.look import load_look
            from agentface.view.renderer import Renderer

            self._renderer = Renderer(self.model, load_look(self.model, self._look))
        geometry = self.geometry if pose is None else self._deformer.at(pose)
        return self._renderer.render(geometry, size=size, camera=camera, quality=quality, alpha=alpha)

    def close(self) -> None:
        """Give back what the face has taken from the graphics driver, and end its voices. May be called twice."""
        self._closed = True
        self._events.close()
        self._agendas.close()
        renderer, self._renderer = self._renderer, None
        if renderer is not None:
            renderer.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            "a Face cannot be copied or pickled: it is at work. Keep its pose, its emotion or its geometry.copy(), "
            "or make another Face of the same model"
        )

    def explain(self) -> Explanation:
        """Which rules make the contractions of the target emotions; has ``as_dict()`` and ``render()``."""
        return self._inference.explain(self.emotion)

    def status(self) -> dict[str, Any]:
        """What the face is doing now, JSON-ready.

        ``face``; ``emotion``, the six target intensities; ``mood``, those that they return to; ``shown``, the
        ``emotion``, the ``contractions`` and the ``shares`` of signed movements as drawn now; ``action_units``, the
        targets of those that are set; ``drivers``, the parameters that each channel moves; ``state`` and
        ``liveliness``; ``speech``, null while the face does not speak, else the ``phone``, null in a pause,
        ``ends_in_s`` and how many utterances are ``waiting``; ``gaze_deg``, yaw and pitch; ``frame_ms``, what the last
        step took; ``messages`` understood; ``errors``, the count of malformed, unknown and rejected ones; and what
        ``reports`` tell.
        """
        emotion, pose = self.channels.emotion, self.pose
        shown = zip(emotion.target, emotion.intensities.tolist(), strict=True)
        return {
            "face": self.model.name,
            "emotion": {name: round(value, 4) for name, value in emotion.target.as_dict().items()},
            "mood": {name: round(value, 4) for name, value in emotion.mood.items()},
            "shown": {
                "emotion": {name: round(value, 4) for name, value in shown},
                "contractions": {name: round(pose[name], 4) for name in CONTRACTIONS},
                "shares": {name: round(pose[name], 4) for name in HELD if name not in CONTRACTIONS},
            },
            "action_units": self.channels.action_units.shown,
            "drivers": self.channels.drivers(),
            "state": self.channels.life.state,
            "liveliness": round(self.channels.life.liveliness, 4),
            "speech": self.channels.speech.status,
            "gaze_deg": [round(math.degrees(pose[name]), 3) for name in ("gaze_yaw", "gaze_pitch")],
            "frame_ms": round(self._frame_ms, 3),
            "messages": self.message_counts.messages,
            "errors": dict(self.message_counts.errors),
            **{name: report() for name, report in self.reports.items()},
        }

    def _touch(self) -> None:
        self._pose = self._geometry = None
