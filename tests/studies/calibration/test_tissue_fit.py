"""The fit of the tissue's muscles, a few steps of it: the whole takes minutes."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.errors import InvalidValueError, Place
from agentface.facs.action_units import load_action_units
from agentface.head.model import load_model
from agentface.studies.calibration.tissue_fit import MuscleFit, TissueFitter
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.reading import anatomy_file, read_tissue

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def model():
    return load_model("amber", asymmetry=0.0)


@pytest.fixture(scope="module")
def fitter(model):
    return TissueFitter(model, read_tissue(anatomy_file()))


def fit_of(fitter, name):
    row = fitter.file.muscles[name]
    others = np.zeros_like(fitter.lattice.rest)
    return MuscleFit(fitter, name, row, load_action_units()[row.action_unit], others)


@pytest.mark.parametrize("name", ["zygomaticus_major", "frontalis_inner", "orbicularis_oculi"])
def test_the_gradient_of_the_loss_is_that_of_finite_differences(fitter, name):
    fit = fit_of(fitter, name)
    place = fit.start()
    place[:-1] = 0.3 + 0.4 * np.clip(place[:-1], 0.0, 1.0)  # off the bounds, and off the anatomist's
    _, gradient = fit.loss(place)
    step = 2e-3
    for index, found in enumerate(gradient):
        way = np.zeros_like(place)
        way[index] = step
        expected = (fit.loss(place + way)[0] - fit.loss(place - way)[0]) / (2 * step)
        assert found == pytest.approx(expected, rel=0.05, abs=1e-2 * np.abs(gradient).max()), index


def test_the_response_is_linear_and_symmetric(fitter):
    draw = np.random.default_rng(0)
    one, two = draw.normal(0, 1, (2, *fitter.lattice.rest.shape))
    first, second = fitter.response(one), fitter.response(two)
    np.testing.assert_allclose(fitter.response(one + 2.0 * two), first + 2.0 * second, atol=1e-9)
    assert (first * two).sum() == pytest.approx((second * one).sum()), "or the adjoint is not this response"
    assert not first[:, ~fitter.lattice.free].any()


def test_a_muscle_pulls_both_sides_alike_and_only_on_the_hypodermis(fitter, model):
    force = fitter.force("risorius", fitter.file.muscles["risorius"])
    assert force[HYPODERMIS].any()
    assert not force[:HYPODERMIS].any()
    np.testing.assert_allclose(force[:, model.mirror] * [-1.0, 1.0, 1.0], force, atol=1e-6)


def test_two_steps_make_a_muscle_better(fitter):
    fit = fit_of(fitter, "frontalis_outer")
    before = fit.loss(fit.start())[0]
    row, loss = fit.run((2,))
    assert loss < 0.9 * before
    old = fitter.file.muscles["frontalis_outer"]
    assert (row.kind, row.regions, row.moved_by) == (old.kind, old.regions, old.moved_by)
    assert row.strength > old.strength
    moved = fitter.equilibrium(fitter.force("frontalis_outer", row))[EPIDERMIS]
    assert 1.0 < moved[:, 1].max() < 10.0, "a brow that rises by millimetres"
    assert round(row.strength, 4) == row.strength


def test_an_action_unit_that_is_not_there_is_told_before_the_work(fitter, model, monkeypatch):
    rows = fitter.file.muscles
    wrong = rows | {"risorius": rows["risorius"].model_copy(update={"action_unit": 99})}
    monkeypatch.setattr(fitter, "file", fitter.file.model_copy(update={"muscles": wrong}))
    with pytest.raises(InvalidValueError, match="99") as caught:
        fitter.fit(lambda _: pytest.fail("fitted"))
    assert caught.value.place == Place("tissue.yaml", ("muscles", "risorius", "action_unit"))
