""":class:`Face`: the whole engine behind a few calls."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Self

import numpy as np

from agentface.bml.block import Block
from agentface.clock import Clock, SystemClock
from agentface.conventions import Bytes, check_duration
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import DEFAULT_DEFORMER, Deformer, make_deformer
from agentface.emotion.explanation import Explanation
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import InvalidValueError
from agentface.events.events import Events
from agentface.events.twins import AwaitableTwins
from agentface.head.model import HeadModel, load_model
from agentface.motion.doing import Doing
from agentface.motion.emotion import Hold
from agentface.motion.gestures.table import all_gestures
from agentface.motion.mixer import Mixer
from agentface.motion.performance import Performance
from agentface.motion.stream import STREAM_FADE_S
from agentface.parameters import CONTRACTIONS, HELD, MUSCLES, FacePose
from agentface.requests import (
    FADE_S,
    GAZE_FADE_S,
    HEAD_FADE_S,
    Blink,
    Gesture,
    Hush,
    LookAt,
    Neutral,
    Play,
    PlayBlock,
    Request,
    Say,
    SetActionUnit,
    SetArkit,
    SetEmotion,
    SetEmotions,
    SetFaps,
    SetGaze,
    SetHead,
    SetLiveliness,
    SetMood,
    SetMuscle,
    SetParameter,
    SetState,
    ShowViseme,
    Speak,
)
from agentface.resources import DEFAULT_FACE
from agentface.speech.phones import Phone
from agentface.talk.blocks import BlockPlayer
from agentface.talk.talker import Talker

if TYPE_CHECKING:
    from agentface.view.renderer import Renderer


@dataclass(slots=True)
class MessageCounts:
    """Counts of the messages that came from outside: those understood, and the others by what was wrong."""

    messages: int = 0
    errors: dict[str, int] = field(default_factory=lambda: dict.fromkeys(("malformed", "unknown", "rejected"), 0))


class Face(AwaitableTwins):
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
        SetLiveliness(liveliness, 0.0).apply(self)
        self._deformer = make_deformer(deformer, self.model, compiled=compiled)
        self._renderer: Renderer | None = None
        self._talker: Talker | None = None
        self._blocks: BlockPlayer | None = None
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
        """Call ``call``, after a step, whenever something is over; one of ``EVENTS``, raises UnknownNameError.

        ``spoken``: a text that was said; ``hushed``: one that was cut short; ``failed``: what went wrong with one, an
        AgentFaceError; ``gestured``: a gesture's name; ``played``: a performance.
        """
        self._events.on(event, call)

    def off(self, event: str, call: Callable[[Any], object]) -> None:
        """No longer call what was given to :meth:`on`."""
        self._events.off(event, call)

    def set_emotion(
        self,
        emotion: str | Mapping[str, float],
        intensity: float | None = None,
        *,
        fade: float | None = None,
        hold: Hold = None,
    ) -> None:
        """Show one emotion at ``intensity`` 0..1 beside the others, or, given a mapping, exactly this state.

        The face gets there in ``fade`` seconds, or at each emotion's own pace. With ``hold`` it goes back to the mood
        after so many seconds, or with ``own`` after as many as are that emotion's.
        ``neutral`` lets go of the emotions alone: at an intensity below 1, or in a mapping, it leaves each of them at
        most 1 minus that; by itself it needs no intensity.
        """
        if not isinstance(emotion, Mapping):
            if intensity is None and canonical_or_neutral(emotion) == NEUTRAL:
                intensity = 1.0
            self.apply(SetEmotion(emotion, intensity, fade, hold))  # type: ignore[arg-type]  # refuses None itself
            return
        if intensity is not None:
            raise InvalidValueError("intensity", "none beside a mapping, which has its own", intensity)
        self.apply(SetEmotions(EmotionState.of(emotion), fade, hold))

    def set_mood(self, mood: Mapping[str, float] | None = None, *, fade: float | None = None) -> None:
        """Have a mood, to which brief expressions and ``neutral`` return: a state of emotions, {} or None for none."""
        self.apply(SetMood(EmotionState.of(mood), fade))

    def neutral(self, fade: float = FADE_S) -> None:
        """Let go of everything, emotions (back to the mood), single muscles, jaw, gaze and head."""
        self.apply(Neutral(fade))

    def set_muscle(self, name: str, contraction: float | None, *, fade: float = FADE_S) -> None:
        """Hold a muscle (both sides where ``name`` has none) at 0..1, whatever else moves it; None releases it."""
        self.apply(SetMuscle(name, contraction, fade))

    def set_parameter(self, name: str, value: float | None, *, fade: float = FADE_S) -> None:
        """Set any one parameter in its unit; an angle in radians, or in degrees with ``_deg`` after its name.

        None releases it: a muscle goes back to the emotions, an angle to 0.
        """
        self.apply(SetParameter(name, value, fade))

    def set_action_unit(
        self, number: int, intensity: float | str, *, side: str | None = None, fade: float = FADE_S
    ) -> None:
        """Show an action unit of FACS at 0..1, or at a letter A to E, on both sides, or on ``left`` or ``right``."""
        self.apply(SetActionUnit(number, intensity, side, fade))  # type: ignore[arg-type]  # takes letters, keeps numbers

    def set_faps(
        self,
        faps: Mapping[int, float],
        *,
        viseme: Sequence[int] | None = None,
        expression: Sequence[int] | None = None,
        fade: float = STREAM_FADE_S,
    ) -> None:
        """Show a frame of MPEG-4 FAPs by number 3..68, in their units; what it does not name is left to others.

        ``viseme`` has the four fields of FAP 1, ``expression`` the six of FAP 2. Half a second after the last frame
        the face lets go of it.
        """
        self.apply(SetFaps(faps, viseme, expression, fade))  # type: ignore[arg-type]  # takes what it makes tuples of

    def set_arkit(self, weights: Mapping[str, float], *, fade: float = STREAM_FADE_S) -> None:
        """Show some of ARKit's 52 face weights, 0..1 by name, beside those that are still shown.

        Half a second after the last ones the face lets go of them.
        """
        self.apply(SetArkit(weights, fade))  # type: ignore[arg-type]  # takes what it makes tuples of

    def set_jaw(self, opening: float | None, *, fade: float = FADE_S) -> None:
        """Hold the jaw open at 0..1 of its widest opening; None releases it."""
        self.apply(SetMuscle("jaw_open", opening, fade))

    def set_gaze(self, yaw_deg: float, pitch_deg: float, *, fade: float = GAZE_FADE_S) -> None:
        """Look ``yaw_deg`` to the person's left (-50..50) and ``pitch_deg`` up (-40..40); a saccade by default."""
        self.apply(SetGaze(yaw_deg, pitch_deg, fade))

    def look_at(self, point: Sequence[float], *, fade: float | None = None) -> None:
        """Look at a point, each eye exactly: x, y, z in metres in the model's axes, where the head is not turned.

        It is looked at until the gaze is told otherwise, whatever turns the head; the head joins the eyes for what is
        far aside. The eyes take ``fade`` seconds, those of a leap so far when None. Raises InvalidValueError for a
        point that is not in front of the eyes.
        """
        self.apply(LookAt.of(point, fade))

    def set_head(self, yaw_deg: float, pitch_deg: float, roll_deg: float = 0.0, *, fade: float = HEAD_FADE_S) -> None:
        """Turn the head to its left (-80..80), up (-60..60), and tilt it to its left (-50..50)."""
        self.apply(SetHead(yaw_deg, pitch_deg, roll_deg, fade))

    def play(self, performance: Performance | None, *, fade: float = 0.0) -> None:
        """Play poses over time from now on, and let go when they end; None ends the one that is played.

        With a fade of 0 every frame is hit exactly; else the face comes to it from what it shows in ``fade`` seconds.
        """
        self.apply(Play(performance, fade))

    def play_block(self, block: Block) -> None:
        """Play a BML block, as :func:`agentface.io.bml.reader.read_bml` reads it; what it says, once it is spoken.

        Raises InvalidValueError for one whose id plays or waits already, and when too many wait.
        """
        self.apply(PlayBlock(block))

    def speak(
        self,
        visemes: Iterable[Phone | Sequence[Any]],
        *,
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        interrupt: bool = False,
        live: bool = False,
        alphabet: str | None = None,
    ) -> None:
        """Move the mouth as for these sounds: name, start and end in seconds, names in any alphabet of ``phones.yaml``.

        Times count from ``start`` seconds after now, or after what is said already; ``interrupt`` says these instead.
        ``live``: more will come; times count from now, and the newest say wins from its first sound on.
        """
        self.apply(Speak.of(visemes, start, rate, loudness, interrupt, live, alphabet))

    def hush(self) -> None:
        """Say no more, now."""
        self.apply(Hush())

    def show_viseme(self, name: str, weight: float, duration: float | None = None) -> None:
        """Show a viseme at 0..1 beside others, for ``duration`` seconds, or until it is set to 0 or :meth:`hush`."""
        self.apply(ShowViseme(name, weight, duration))

    def blink(self) -> None:
        """Blink once."""
        self.apply(Blink())

    def gesture(self, name: str, strength: float = 1.0) -> None:
        """Nod, shake, tilt, ...: a gesture of ``rules/gestures.yaml``, at ``strength`` 0..1."""
        self.apply(Gesture(name, strength))

    def set_liveliness(self, liveliness: float, *, fade: float | None = None) -> None:
        """Blink, look about, sway and breathe between messages: 0, perfectly still, .. 1; 0.6 is natural.

        In ``fade`` seconds, those of ``rules/life.yaml`` when None.
        """
        self.apply(SetLiveliness(liveliness, fade))

    def set_state(self, state: str | None) -> None:
        """What it lives for: ``idle``, ``listening``, ``thinking`` or ``speaking``.

        None, as at first: ``speaking`` while the face speaks, and ``idle`` otherwise.
        """
        self.apply(SetState(state))

    def say(
        self,
        text: str,
        *,
        voice: str | None = None,
        language: str = "en",
        rate: float = 1.0,
        interrupt: bool = False,
        wait: bool = False,
    ) -> None:
        """Say a text, sentence by sentence, when its turn has come; ``interrupt``: in place of what is said now.

        Emotions in brackets, as in ``[joy] Hello, [surprise:0.5] you``, are shown at their words. The text is spoken
        in the background and begins with the step that finds its first sentence ready; ``wait`` until all of it is, as
        in a program that steps faster than time passes, and it begins with the next one. What goes wrong in the
        background is told to ``talker.failed``; that of a text or voice is raised: InvalidValueError, UnknownNameError.
        """
        self.apply(Say(text, voice, language, rate, interrupt))
        if wait:
            self.talker.wait()

    def step(self, dt: float) -> FaceGeometry:
        """Let ``dt`` seconds pass, and return the face as it is then.

        The arrays of the geometry hold until this face's next step; ``copy()`` keeps them.
        """
        dt = check_duration("dt", dt)
        start = self._clock.now()
        self._events.take_in()
        self._advance(dt)
        self._touch()
        geometry = self._deformer.step(self.pose, dt)
        self._stepped = self.pose, geometry
        self._frame_ms = 1000.0 * (self._clock.now() - start)
        self._events.settle()
        return geometry

    def warm_up(self) -> None:
        """Compile or load now what the first message and the first frame need, so that they are shown at once.

        Takes seconds the first time on a machine, half a second later on. Changes nothing that is shown.
        """
        shown = Mixer(self._inference)
        shown.emotion.change({EMOTIONS[0]: 1.0}, None, None)
        shown.advance(0.1)
        self.channels.speech.warm_up()
        self._deformer.at(FacePose.of(**dict.fromkeys(MUSCLES, 1.0)))

    @property
    def talker(self) -> Talker:
        """What has texts said, and tells when each is heard."""
        if self._talker is None:
            self._talker = Talker(self)
            self.noted.append(self._talker.notice)
        return self._talker

    @property
    def blocks(self) -> BlockPlayer:
        """What plays BML blocks, and tells how far they are."""
        if self._blocks is None:
            self._blocks = BlockPlayer(self)
            self.noted.append(self._blocks.notice)
        return self._blocks

    def _advance(self, dt: float) -> None:
        agendas = [agenda for agenda in (self._blocks, self._talker) if agenda is not None]
        for agenda in agendas:
            agenda.advance(0.0)
        while agendas and (part := min(agenda.due_s for agenda in agendas)) < dt:
            self.channels.advance(part)
            for agenda in agendas:
                agenda.advance(part)
            dt -= part
        self.channels.advance(dt)
        for agenda in agendas:
            agenda.advance(dt)

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
        if self._talker is not None:
            self._talker.close()
        if self._blocks is not None:
            self._blocks.close()
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
