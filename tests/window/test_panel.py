"""The panel on a virtual display, used with a real mouse and real keys."""

import shutil

import pytest

from agentface.resources import face_folder
from agentface.tissue.reading import read_tissue

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_sliders_undo_and_help(on_a_display):
    seen = on_a_display("""
        def play():
            yield from frames(3)
            controls = window.controls
            camera = controls.camera
            yield from drag(at("happiness", 0.03), at("happiness", 0.8))
            seen["dragged"] = dict(controls.face.emotion)
            yield from key("ctrl+z")
            seen["undone"] = dict(controls.face.emotion)
            yield from click("Redo")
            seen["redone"] = dict(controls.face.emotion)
            yield from click("happiness", button=3)
            seen["right click"] = dict(controls.face.emotion)

            yield from point(*at("sadness"))
            xdo("keydown", "ctrl", "click", 1, "keyup", "ctrl")
            yield from until(lambda: window._interface.typing)
            xdo("key", "ctrl+a", "period", "2", "5", "h")
            yield from frames(6)
            xdo("key", "Return")
            yield from until(lambda: not window._interface.typing)
            seen["typed"] = dict(controls.face.emotion)
            seen["help while typing"] = controls.helping

            yield from click("gaze", 0.9)
            seen["gaze"] = controls.face.turned_deg
            yield from click("Amused contempt")
            seen["preset"] = dict(controls.face.emotion)

            xdo("click", 5)
            yield from frames(3)
            seen["camera"] = controls.camera == camera
            face = pictures[0][:, :200].astype(int)
            yield from key("h")
            yield from until(lambda: np.abs(pictures[0][:, :200] - face).mean() > 10)
            seen["help"] = controls.helping
            yield from key("Escape")
            seen["closed"] = controls.helping, controls.closing

        show(Face(), size=(560, 900))
    """)
    neutral = dict.fromkeys(seen["dragged"], 0.0)
    assert 0.6 < seen["dragged"]["happiness"] < 1.0
    assert seen["dragged"] | {"happiness": 0.0} == neutral
    assert seen["undone"] == neutral, "the whole drag is one step"
    assert seen["redone"] == seen["dragged"]
    assert seen["right click"] == neutral
    assert seen["typed"] == neutral | {"sadness": 0.25}
    assert seen["help while typing"] is False
    assert seen["gaze"]["gaze_yaw"] > 30
    assert seen["preset"] == neutral | {"happiness": 0.6, "disgust": 0.6}
    assert seen["camera"], "what is done in the panel does not move the camera"
    assert seen["help"]
    assert seen["closed"] == [False, False]


def test_muscles_and_rules(on_a_display):
    seen = on_a_display("""
        def play():
            yield from frames(3)
            controls = window.controls
            for section in ("Emotions", "Presets", "View", "Gaze, jaw, head", "Muscles"):
                yield from click(section)
            yield from click("Brow")
            both = "procerus_l procerus_r"
            yield from drag(at(both, 0.03), at(both, 0.9))
            seen["both"] = controls.face.held
            apart = max((place for label, place in buttons() if label == "L R"), key=lambda place: place[1])
            yield from point(*middle(apart))
            xdo("click", 1)
            yield from until(lambda: "procerus_l" in places)
            places.pop(both)
            yield from frames()
            seen["apart"] = sorted(controls.apart), both in places
            yield from click("procerus_l", 0.3)
            seen["left"] = controls.face.held
            seen["seen from the front"] = places["procerus_r"][0] < places["procerus_l"][0]
            yield from click("auto")
            seen["released"] = controls.face.held

            yield from click("Muscles")
            yield from click("Rules that fired")
            yield from click("Frame time")
            yield from frames()
            controls.preset("fear")
            yield from frames()
            seen["rules"] = bars
            seen["frame"] = window.times.draw_ms > 0

        def buttons():
            return pressed.items()

        def middle(place):
            return round(0.5 * (place[0] + place[2])), round(0.5 * (place[1] + place[3]))

        pressed, bars = {}, []
        small, bar = imgui.small_button, imgui.progress_bar

        def noted_button(label):
            result = small(label)
            pressed[label] = places[label]  # the lowest one of its name is the last
            return result

        def noted_bar(fraction, *rest):
            bars.append(fraction)
            bar(fraction, *rest)

        imgui.small_button, imgui.progress_bar = noted_button, noted_bar
        show(Face(), size=(560, 900))
    """)
    assert seen["both"].keys() == {"procerus_l", "procerus_r"}
    assert seen["both"]["procerus_l"] == seen["both"]["procerus_r"] > 0.4
    assert seen["apart"] == [["procerus"], False]
    assert 0.1 < seen["left"]["procerus_l"] < 0.5
    assert seen["left"]["procerus_r"] == seen["both"]["procerus_r"]
    assert seen["seen from the front"]
    assert seen["released"] == {}
    assert max(seen["rules"]) == 1.0
    assert seen["frame"]


def test_the_skull_is_nudged_seen_and_saved(on_a_display, tmp_path):
    shutil.copytree(face_folder("amber"), tmp_path / "amber")
    file = tmp_path / "amber" / "tissue.yaml"
    before = file.read_text()
    seen = on_a_display(f"""
        from dataclasses import replace
        from agentface.tissue.deformer import TissueDeformer

        def remade(self, file, pose):  # at once
            tissue = self.tissue._replace(lattice=replace(self.tissue.lattice, file=file))
            return TissueDeformer(self._model, tissue=tissue)

        TissueDeformer.remade = remade

        def play():
            yield from frames(3)
            skull = window.controls.skull
            for section in ("Emotions", "Presets", "View", "Gaze, jaw, head", "Skull"):
                yield from click(section)
            face = below_the_hint()
            yield from click("Show the bone", 0.1)
            yield from frames()
            seen["bone"] = float(np.abs(below_the_hint() - face).mean())
            first = window.controls.face.deformer

            yield from point(*at("translate_mm_z"))
            yield from arrives("mousedown", 1)
            yield from frames()
            yield from point(*at("translate_mm_z", 0.98))
            seen["dragged"] = skull.table.translate_mm, skull.preparing
            seen["stands out"] = skull.nearness().outside_mm
            yield from arrives("mouseup", 1)
            yield from until(lambda: window.controls.face.deformer is not first)
            seen["made"] = window.controls.face.deformer.tissue.lattice.file.skull.translate_mm
            yield from click("translate_mm_z", button=3)
            seen["right click"] = skull.table.translate_mm
            yield from click("scale_x", 0.9)
            yield from click("save skull")
            seen["scale"] = skull.table.scale
            yield from click("reset skull")
            seen["reset"] = skull.nudged
            yield from until(lambda: not skull.preparing)
            yield from click("Show the bone", 0.1)
            yield from frames()
            seen["face"] = float(np.abs(below_the_hint() - face).mean())

        def below_the_hint():
            return pictures[0][320:, :200].astype(int)

        show(Face({str(tmp_path / "amber")!r}, deformer="tissue"), size=(560, 700))
    """)
    assert seen["bone"] > 10
    assert seen["dragged"] == [[0.0, 0.0, 10.0], False]
    assert seen["stands out"] > 1.0
    assert seen["made"] == [0.0, 0.0, 10.0]
    assert seen["right click"] == [0.0, 0.0, 0.0]
    assert 1.05 < seen["scale"][0] <= 1.1
    assert seen["reset"] is False
    assert seen["face"] < 0.5
    after = file.read_text().splitlines()
    changed = [line for line, was in zip(after, before.splitlines(), strict=True) if line != was]
    assert len(changed) == 1
    assert read_tissue(file).skull.scale == seen["scale"]


def test_a_picture_and_a_film_that_is_cut_off_by_closing(on_a_display, tmp_path):
    import av
    from PIL import Image

    seen = on_a_display(f"""
        from pathlib import Path
        from agentface.io.picture import write_picture
        from agentface.io.video import VideoWriter

        def play():
            yield from frames(3)
            yield from click("Screenshot")
            yield from click("record")
            yield from until(lambda: (capture.filmed_s or 0) > 0.3)
            seen["size"] = window._targets.size
            seen["said"] = said

        said = []
        capture = Capture(write_picture, VideoWriter, said.append, Path({str(tmp_path)!r}))
        show(size=(561, 421), capture=capture)
    """)
    (picture,), (film,) = tmp_path.glob("*.png"), tmp_path.glob("*.mp4")
    width, height = seen["size"]
    with Image.open(picture) as image:
        assert image.size == (width, height)
        assert max(high - low for low, high in image.getextrema()) > 100
    with av.open(str(film)) as container:
        frames = list(container.decode(video=0))
    assert (frames[0].width, frames[0].height) == (width // 2 * 2, height // 2 * 2)
    assert len(frames) > 1
    assert seen["said"][0] == f"wrote {picture}"
