from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from agentface.deform.muscles.combine import parallel
from agentface.facs.action_units import ActionUnit
from agentface.head.model import load_model
from agentface.head.muscles import MusclesFile, anchor_point, read_muscles
from agentface.mesh.glb import Shape
from agentface.studies.calibration.agreement import measure
from agentface.studies.calibration.calibrate import anatomy_file
from agentface.studies.calibration.fit import Fitter, groups

UNIT = ActionUnit(15, "", {"depressor_anguli_oris": 1.0}, {"known": 1.0}, 1.0)


@pytest.fixture(scope="module")
def anatomy():
    return read_muscles(anatomy_file())


@pytest.fixture(scope="module")
def known(anatomy):
    """The muscle that made the target: elsewhere than the anatomist's, inside the bounds."""
    row = anatomy.muscles["depressor_anguli_oris"]
    return row.model_copy(
        update={
            "origin": _moved(row.origin, (0.1, 0.12, -0.1)),
            "insertion": _moved(row.insertion, (-0.1, 0.05, 0.1)),
            "zone_deg": 30.0,
            "fall_start": 0.7,
            "fall_finish": 1.2,
            "elasticity": 0.2,
        }
    )


def _moved(anchor, by):
    return anchor.model_copy(update={"offset": [a + b for a, b in zip(anchor.offset, by, strict=True)]})


@pytest.fixture(scope="module")
def model(anatomy, known):
    """A face whose one shape was made by the known muscle."""
    muscles = MusclesFile(falloff="smooth", muscles=anatomy.muscles | {"depressor_anguli_oris": known})
    face = load_model("amber", muscles=muscles)
    contractions = np.array([name.startswith("depressor_anguli_oris") for name in face.muscles.names], float)
    moved = (parallel(face.vertices, face.muscles, contractions) - face.vertices).astype(np.float32)
    return dataclasses.replace(face, shapes={"known": _shape(moved)}, muscles_file=anatomy)


def _shape(moved):
    vertices = np.flatnonzero(moved.any(axis=1))
    return Shape(vertices.astype(np.int32), moved[vertices])


@pytest.fixture(scope="module")
def fit(model, anatomy):
    said = []
    fitter = Fitter(model, anatomy, groups([UNIT])[0])
    values, cost = fitter.solve(1, np.random.default_rng(0), said.append)
    return fitter, values, cost, said


@pytest.mark.slow
def test_the_fit_finds_a_muscle_that_does_what_the_known_one_does(fit, model, anatomy):
    fitter, values, cost, said = fit
    first = 0.5 * (fitter.residuals(fitter.start()) ** 2).sum()
    assert cost < first / 50
    assert cost == pytest.approx(0.5 * (fitter.residuals(values) ** 2).sum())
    assert len(said) == 1
    assert "AU 15" in said[0]
    fitted = MusclesFile(falloff="smooth", muscles=anatomy.muscles | fitter.fitted(values))
    before = measure(model, {15: UNIT})[15]
    after = measure(dataclasses.replace(model, muscles_file=fitted), {15: UNIT})[15]
    assert before.cosine < 0.96
    assert after.cosine > 0.99
    assert after.peak_ratio == pytest.approx(1.0, abs=0.05)


def test_the_fit_stays_inside_its_bounds(fit, model, anatomy):
    fitter, values, _, _ = fit
    low, high = fitter.bounds()
    assert ((values >= low) & (values <= high)).all()
    before, after = anatomy.muscles["depressor_anguli_oris"], fitter.fitted(values)["depressor_anguli_oris"]
    for old, new, within in ((before.origin, after.origin, 0.40), (before.insertion, after.insertion, 0.25)):
        assert new.at == old.at
        assert np.abs(np.subtract(new.offset, old.offset)).max() <= within + 1e-4
    kept = {"regions", "not_regions", "fade", "wrinkles"}
    assert after.model_dump(include=kept) == before.model_dump(include=kept)


def test_the_rows_of_the_fit_are_the_muscles_of_the_file(fit, model, anatomy):
    fitter, values, _, _ = fit
    row = fitter.fitted(values)["depressor_anguli_oris"]
    for side, fitted in zip("lr", fitter.rows(values), strict=True):
        unit = model.landmarks.eye_separation
        np.testing.assert_allclose(fitted[:3], anchor_point(row.origin, side, model.landmarks), atol=1e-5)
        np.testing.assert_allclose(fitted[3:6], anchor_point(row.insertion, side, model.landmarks), atol=1e-5)
        assert fitted[6] == pytest.approx(np.cos(np.radians(row.zone_deg)), abs=1e-4)
        expected = unit * np.array([row.fall_start, row.fall_finish, row.elasticity])
        np.testing.assert_allclose(fitted[7:], expected, atol=1e-5)


@pytest.mark.slow
@pytest.mark.untraced
def test_the_fit_is_the_same_for_the_same_seed(model, anatomy):
    fitter = Fitter(model, anatomy, groups([UNIT])[0])
    one, two = (fitter.solve(1, np.random.default_rng(4), lambda _: None) for _ in range(2))
    np.testing.assert_array_equal(one[0], two[0])
    assert one[1] == two[1]
