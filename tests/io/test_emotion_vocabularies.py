from __future__ import annotations

import pytest
from emotionml_documents import FEAR, PUBLISHED, document, emotion, notes
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.emotion.vocabularies import Scales, Words, published
from agentface.io.emotionml import read_emotionml

MINE = "http://example.org/vocabularies#mine"


def state(content, time_s=1.0, **sets):
    return read_emotionml(document(emotion(content, **sets), attributes="")).state(time_s)


def descriptor(kind, name, said='value="1"'):
    return f'<{kind} name="{name}" {said}/>'


def set_of(name):
    return {f"{published()[name].type.replace('-', '_')}_set": f"{PUBLISHED}{name}"}


WORDS = [(name, word) for name, words in published().items() if isinstance(words, Words) for word in words.mixtures]


def test_every_published_word_is_shown_as_its_mixture_and_in_proportion():
    for name, word in WORDS:
        kind, mixture = published()[name].type, published()[name].mixtures[word]
        assert state(descriptor(kind, word), **set_of(name)) == EmotionState.of(mixture), (name, word)
        half = {emotion: share / 2 for emotion, share in mixture.items()}
        shown = state(descriptor(kind, word, 'value="0.5"'), **set_of(name))
        assert shown.as_dict() == pytest.approx(EmotionState.of(half).as_dict())


def test_every_published_scale_is_read():
    for name, scales in published().items():
        if isinstance(scales, Scales):
            for scale in scales.names:
                said = [emotion(descriptor(scales.type, scale, f'value="{value}"'), **set_of(name)) for value in (0, 1)]
                score = read_emotionml(document(*said))
                assert bool(score.cues) == scales.says(scale) == (not score.notes), (name, scale)


@pytest.mark.parametrize(
    ("values", "strongest"),
    [
        ((0.9, 0.75, 0.73), "happiness"),
        ((0.18, 0.37, 0.33), "sadness"),
        ((0.25, 0.8, 0.63), "anger"),
        ((0.18, 0.8, 0.28), "fear"),
        ((0.2, 0.68, 0.56), "disgust"),
        ((0.7, 0.84, 0.43), "surprise"),
    ],
)
def test_pleasure_arousal_and_dominance(values, strongest):
    content = "".join(
        f'<dimension name="{name}" value="{value}"/>'
        for name, value in zip(("pleasure", "arousal", "dominance"), values, strict=True)
    )
    shown = state(content, **set_of("pad-dimensions"))
    assert shown[strongest] > 0.8
    assert sum(shown.values()) < 1.2


def test_the_middle_of_the_dimensions_is_the_face_at_rest():
    middle = "".join(f'<dimension name="{name}" value="0.5"/>' for name in published()["fsre-dimensions"].names)
    assert state(middle, **set_of("fsre-dimensions")) == EmotionState()


def test_dimensions_over_time():
    content = (
        '<dimension name="arousal"><trace freq="2Hz" samples="0.5 1 0.5"/></dimension>'
        '<dimension name="pleasure"><trace freq="10Hz" samples="0.5 0.5 0.5 0.5 0.5 0.25"/></dimension>'
    )
    score = read_emotionml(document(emotion(content, **set_of("pad-dimensions"))))
    assert score.duration_s == 1.5
    assert score.state(0.0) == EmotionState()
    assert score.state(0.5)["anger"] > score.state(0.4)["anger"] > 0.3, "aroused and displeased"
    assert score.state(0.5)["happiness"] == 0.0
    assert any(score.state(1.2).values()), "the shorter trace holds"


def test_appraisals_work_together():
    def shown(**values):
        content = "".join(
            descriptor("appraisal", name.replace("_", "-"), f'value="{value}"') for name, value in values.items()
        )
        return state(content, **set_of("scherer-appraisals"))

    assert shown(goal_conduciveness=1, intrinsic_pleasantness=1)["happiness"] > 0.7
    obstructed = {power: shown(goal_conduciveness=0, power=power) for power in (0, 1)}
    assert obstructed[1]["anger"] > 0.6 > obstructed[0]["anger"]
    assert obstructed[0]["sadness"] + obstructed[0]["fear"] > 0.8 > obstructed[1]["sadness"] + obstructed[1]["fear"]
    sudden = shown(suddenness=0.9)
    assert max(sudden, key=sudden.get) == "surprise"
    assert not any(shown(suddenness=0).values())


def test_an_appraisal_without_a_value_is_made():
    scherer = set_of("scherer-appraisals")
    assert state('<appraisal name="power"/>', **scherer) == state(descriptor("appraisal", "power"), **scherer)


@pytest.mark.parametrize(
    ("others", "shown"),
    [
        ('<dimension name="pleasure" value="1"/>', {"fear": 1.0}),
        ('<action-tendency name="agonistic"/>', {"fear": 1.0}),
        ('<appraisal name="x" value="1"/>', {"fear": 1.0}),
    ],
)
def test_what_describes_an_emotion_in_other_words_beside_categories_is_not_shown_twice(others, shown):
    sets = {"appraisal_set": MINE, **set_of("pad-dimensions"), **set_of("frijda-action-tendencies")}
    said = emotion(FEAR + others, **sets)
    assert read_emotionml(document(said)).state(1.0) == EmotionState.of(shown)


def test_where_the_categories_say_nothing_the_next_kind_is_shown():
    content = '<category name="boredom"/><action-tendency name="agonistic" value="0.5"/>'
    said = emotion(content, category_set=MINE, **set_of("frijda-action-tendencies"))
    score = read_emotionml(document(said))
    assert score.state(1.0) == EmotionState.of(anger=0.5)
    assert [note.where for note in score.notes] == ["emotion 1.category-set"]


def test_vocabularies_of_others_are_taken_by_their_words():
    (note,) = notes(*[emotion('<category name="Joyful"/>', category_set=MINE)] * 3)
    assert "it is not read" in note
    assert state('<category name="Joyful"/>', category_set=MINE) == EmotionState.of(happiness=1.0)
    assert state('<category name="pity"/>', category_set=MINE)["sadness"] > 0.5
    assert state('<dimension name="potency" value="0"/>', dimension_set=MINE) == state(
        '<dimension name="potency" value="0"/>', **set_of("fsre-dimensions")
    )


def test_a_vocabulary_of_the_document():
    vocabulary = (
        '<vocabulary type="category" id="mine"><item name="fear"/><item name="boredom"/></vocabulary>'
        '<vocabulary type="dimension" id="pa"><item name="arousal"/><item name="pleasure"/></vocabulary>'
    )
    dimensions = '<dimension name="arousal" value="1"/><dimension name="pleasure" value="0.2"/>'
    score = read_emotionml(
        document(vocabulary, emotion(category_set="#mine"), emotion(dimensions, dimension_set="#pa"), attributes="")
    )
    assert score.state(1.0) == EmotionState.of(fear=1.0)
    assert score.state(3.0) == state(dimensions, **set_of("pad-dimensions"))


def test_the_emotion_s_set_counts_before_the_document_s():
    said = emotion('<category name="angry"/>', category_set=f"{PUBLISHED}everyday-categories")
    assert read_emotionml(document(said)).state(1.0) == EmotionState.of(anger=1.0)


def test_https_is_the_same():
    assert state(FEAR, category_set=f"{PUBLISHED}big6".replace("http:", "https:")) == EmotionState.of(fear=1.0)


@given(st.dictionaries(st.sampled_from(published()["scherer-appraisals"].names), st.floats(0, 1), min_size=1))
def test_any_appraisals_are_a_state(values):
    content = "".join(descriptor("appraisal", name, f'value="{value!r}"') for name, value in values.items())
    shown = state(content, **set_of("scherer-appraisals"))
    assert list(shown) == list(EMOTIONS)
