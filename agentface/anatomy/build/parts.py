"""The hand-made numbers of a face's parts: the sections of ``anatomy.yaml`` beside the muscles."""

from __future__ import annotations

from pydantic import ConfigDict

from agentface.anatomy.build.jaw import JawShares
from agentface.anatomy.lids import LidMotion
from agentface.anatomy.model import EyeHole
from agentface.anatomy.orbicularis_oris import LipsMotion
from agentface.anatomy.regions import Limits
from agentface.anatomy.volumes import VolumeRow
from agentface.anatomy.wrinkles import TrainRow
from agentface.config import Table


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
