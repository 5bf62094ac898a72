"""The hand-made numbers of a face's parts: the sections of ``anatomy.yaml`` beside the muscles."""

from __future__ import annotations

from pydantic import ConfigDict

from agentface.config import Table
from agentface.head.build.jaw import JawShares
from agentface.head.lids import LidMotion
from agentface.head.model import EyeHole
from agentface.head.morphs import MorphRow
from agentface.head.orbicularis_oris import LipsMotion
from agentface.head.regions import Limits
from agentface.head.volumes import VolumeRow
from agentface.head.wrinkles import TrainRow


class PartsFile(Table):
    """What the build takes from ``anatomy.yaml``; the muscles in it are the calibration's."""

    model_config = ConfigDict(extra="ignore")

    jaw: JawShares
    limits: Limits
    eyelids: LidMotion
    lips: LipsMotion
    eyes: EyeHole
    wrinkles: dict[str, TrainRow]
    volumes: dict[str, VolumeRow]
    morphs: dict[str, MorphRow]
