"""Pictures against the ones that were looked at and stored."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

FOLDER = Path(__file__).parent / "goldens"
CHANNEL = 2
SHARE = 0.001


class Goldens:
    """The stored pictures.

    Args:
        failures: where the pictures of what differs go.
        regenerate: store what is drawn now as right.
        folder: where the stored ones are.
    """

    def __init__(self, failures: Path, *, regenerate: bool = False, folder: Path = FOLDER) -> None:
        self.failures, self.regenerate, self.folder = failures, regenerate, folder
        self.wrong: list[str] = []

    def compare(self, name: str, actual: np.ndarray) -> None:
        """Note ``name`` in ``wrong`` where ``actual (H, W, 3)`` differs, and write all that shows how."""
        path = self.folder / f"{name}.png"
        if self.regenerate:
            path.parent.mkdir(parents=True, exist_ok=True)
            Image.fromarray(actual).save(path, optimize=True)
            return
        self.failures.mkdir(parents=True, exist_ok=True)
        if not path.exists():
            Image.fromarray(actual).save(self.failures / f"{name}-actual.png")
            self.wrong.append(f"{name}: no such golden yet")
            return
        with Image.open(path) as image:
            expected = np.asarray(image)
        said = difference(actual, expected)
        if not said:
            return
        self.wrong.append(f"{name}: {said}")
        Image.fromarray(actual).save(self.failures / f"{name}-actual.png")
        Image.fromarray(expected).save(self.failures / f"{name}-expected.png")
        if actual.shape == expected.shape:
            shown = np.clip(8 * np.abs(actual.astype(int) - expected), 0, 255).astype(np.uint8)
            Image.fromarray(shown).save(self.failures / f"{name}-difference.png")

    def check(self) -> None:
        """Fail when a picture differed."""
        found = "\n".join(self.wrong)
        assert not self.wrong, (
            f"{found}\nactual, expected and difference (8 times) are in {self.failures};"
            " where the new ones are right: pytest --regen-goldens"
        )


def difference(actual: np.ndarray, expected: np.ndarray) -> str:
    """What is wrong: more than 0.1 % of the pixels differ by more than 2 in a channel; empty where nothing is."""
    if actual.shape != expected.shape:
        return f"its shape is {actual.shape}, that of the golden {expected.shape}"
    gap = np.abs(actual.astype(int) - expected).max(axis=2)
    share = float((gap > CHANNEL).mean())
    return f"{share:.2%} of the pixels differ, the most by {gap.max()}" if share > SHARE else ""


def reduced(image: Image.Image, factor: int) -> np.ndarray:
    """``image`` with one pixel, their mean, for ``factor`` by ``factor``."""
    return np.asarray(image.convert("RGB").reduce(factor))
