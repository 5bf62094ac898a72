"""What motion costs a frame, without deformation: faces that are still, told, alive, and all of it while they speak."""

from __future__ import annotations

from statistics import fmean, median
from time import perf_counter
from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.inference import default_inference
from agentface.motion.eyesight import Eyesight
from agentface.motion.mixer import Mixer
from agentface.speech.phones import Phone

HZ = 60
NATURAL = 0.6
_POINT = (0.1, 0.0, 0.6)
_FAMILY = ("fear", "happiness", "surprise")


def told(mixer: Mixer, second: int) -> None:
    """What a program asks each second: another emotion, gaze, head, a blink."""
    mixer.emotion.change({_FAMILY[second % len(_FAMILY)]: float(second % 2)}, 0.8, None)
    mixer.gaze.turn((0.1 * (second % 3), 0.05, 0.0), 0.1)
    mixer.head.turn((0.1 * (second % 4), 0.05, 0.0), 0.8)
    mixer.blink.blink()


def everything(mixer: Mixer, second: int, eyesight: Eyesight) -> None:
    """The same of a face that lives, looks at a point, nods and speaks without end."""
    told(mixer, second)
    mixer.gaze.look_at(eyesight, _POINT)
    mixer.gestures.play("nod")
    mixer.life.beat()
    names = ("aa", "PP", "iy", "SS")
    phones = [Phone(name, 0.25 * place, 0.25 * place + 0.25) for place, name in enumerate(names)]
    mixer.speech.speak(phones, interrupt=True)


def run(model: Any, seconds: int = 20) -> dict[str, Any]:
    """Microseconds a frame of ``advance`` and ``pose``, four faces in turn: the median, and the mean."""
    inference, eyesight = default_inference(), Eyesight.of(model)
    mixers = {name: Mixer(inference, random=np.random.default_rng(0)) for name in ("still", "told", "living", "all")}
    for name in ("living", "all"):
        mixers[name].life.set_liveliness(NATURAL, 0.0)
    mixers["all"].life.set_state("speaking")
    mixers["all"].speech.warm_up()
    times = {name: np.empty(seconds * HZ) for name in mixers}
    for frame in range(-HZ, seconds * HZ):
        for name, mixer in mixers.items():
            if frame % HZ == 0 and name in ("told", "all"):
                if name == "told":
                    told(mixer, frame // HZ)
                else:
                    everything(mixer, frame // HZ, eyesight)
            start = perf_counter()
            mixer.advance(1.0 / HZ)
            mixer.pose()
            if frame >= 0:
                times[name][frame] = 1e6 * (perf_counter() - start)
    return _figures(times)


def _figures(times: dict[str, Doubles]) -> dict[str, Any]:
    # of the slowest hundredth the machine's other work is to blame
    kept = {name: np.sort(each)[: max(1, round(0.99 * len(each)))].tolist() for name, each in times.items()}
    medians, means = ({name: of(each) for name, each in kept.items()} for of in (median, fmean))
    return {
        **{f"{name}_us": value for name, value in medians.items()},
        **{f"{name}_mean_us": value for name, value in means.items()},
        "life_us": medians["living"] - medians["still"],
        "life_mean_us": means["living"] - means["still"],
        "all_to_told_ratio": means["all"] / means["told"],
    }
