import numpy as np
import pytest

from agentface.view.skin.pores import SIDE, pore_volume


@pytest.fixture(scope="module")
def volume():
    return pore_volume(np.random.default_rng(3))


def test_the_same_generator_gives_the_same_bytes(volume):
    assert volume.shape == (SIDE, SIDE, SIDE, 4)
    assert volume.dtype == np.uint8
    np.testing.assert_array_equal(volume, pore_volume(np.random.default_rng(3)))
    assert (volume != pore_volume(np.random.default_rng(4))).any()


def test_it_tiles(volume):
    """Over its border it changes no more than inside."""
    height = volume[..., 3].astype(int)
    for axis in range(3):
        steps = np.abs(np.diff(height, axis=axis))
        over = np.abs(np.take(height, 0, axis) - np.take(height, -1, axis))
        assert over.mean() < 1.2 * steps.mean()


def test_the_slopes_are_those_of_the_height(volume):
    height = volume[..., 3].astype(float)
    for channel, axis in enumerate((2, 1, 0)):  # x is the last axis of the texture's rows
        slope = np.roll(height, -1, axis) - np.roll(height, 1, axis)
        stored = volume[..., channel].astype(float) - 128
        assert np.corrcoef(slope.ravel(), stored.ravel())[0, 1] > 0.99
        assert abs(stored.mean()) < 2


def test_pits_are_deeper_than_furrows_and_few(volume):
    height = volume[..., 3] / 255
    assert 0.005 < (height < 0.3).mean() < 0.3
    assert np.median(height) > 0.3
