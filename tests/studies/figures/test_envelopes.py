from __future__ import annotations

from io import BytesIO

import numpy as np
from PIL import Image

from agentface.emotion.inference import default_inference
from agentface.studies.figures import envelopes
from agentface.studies.figures.line_chart import COLOURS, ChartLine, LineChart


def test_the_figure_shows_four_charts():
    ((name, content),) = envelopes.figures("amber").items()
    assert name == "envelopes.png"
    assert Image.open(BytesIO(content)).size[0] > 1200


def test_a_face_is_told_things_at_their_times():
    scripts = {0.1: lambda channel: channel.change({"fear": 0.5}, 0.0, None)}
    levels, contractions = envelopes.course(scripts, 0.2)
    assert (levels[:20] == 0.0).all()
    assert (levels[20:, 3] == 0.5).all()
    np.testing.assert_array_equal(contractions[-1], default_inference().contractions({"fear": 0.5}))


def test_a_line_goes_from_its_first_value_to_its_last():
    times = np.linspace(0.0, 1.0, 50)
    chart = LineChart(times, [ChartLine("rises", times, 2)], size=(400, 300))
    red = np.abs(np.asarray(chart.picture(), int) - COLOURS[2]).sum(axis=2) < 60
    rows, columns = np.nonzero(red[40:])
    assert rows[columns == columns.min()].min() > rows[columns == columns.max()].max() + 150
    assert columns.max() - columns.min() > 300
