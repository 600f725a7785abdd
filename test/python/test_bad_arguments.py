"""What is wrong with an argument is said, with the place; the map stays as it was."""
import numpy as np
import pytest

import semantic_octree
from support import NAMES, RESOLUTION, map_of_yard

NAN, INF = float("nan"), float("inf")
POINTS = np.arange(12.0).reshape(4, 3)
NO_POINTS = [  # N x 3 numbers, and what is said of them
    (np.zeros(3), r"points: expected N x 3 real numbers, got float64 of shape \(3,\)"),
    (np.zeros((4, 2)), r"points: .* of shape \(4, 2\)"),
    (np.zeros((4, 4)), r"points: .* of shape \(4, 4\)"),
    (np.zeros((1, 4, 3)), r"points: .* of shape \(1, 4, 3\)"),
    (np.zeros(()), "points: "),
    (np.zeros((4, 3), complex), "points: .*complex128"),
    (np.zeros((4, 3), bool), "points: .*bool"),
    (np.full((4, 3), "1"), "points: .*<U1"),
    (np.full((4, 3), None), "points: .*object"),
    (np.zeros((4, 3), "datetime64[s]"), "points: .*datetime64"),
    (np.zeros(4, [("x", float), ("y", float)]), "points: "),
    ([[1, 2, 3], [4, 5]], "points: "),
    ("points", "points: "),
    (None, "points: "),
    (object(), "points: "),
    (np.broadcast_to(np.zeros(3), (10**11, 3)), "points: 100000000000 rows are more than memory holds"),
]
BAD_LABELS = [
    ([1, 2, 3], r"labels: expected 4 whole numbers, or as many rows of 3 probabilities, got int64 of shape \(3,\)"),
    ([1, 2, 4, 0], "labels: 4 in row 2, expected 0 .none. to 3"),
    ([1, 2, 0, -1], "labels: -1 in row 3"),
    (np.array([1, 255, 0, 0], np.uint8), "labels: 255 in row 1"),
    (np.array([1, 257, 0, 0], np.uint16), "labels: 257 in row 1"),
    (np.array([1, 0, 0, 2**40]), "labels: 1099511627776 in row 3"),
    (np.array([1, 0, 0, 2**64 - 1], np.uint64), "labels: 18446744073709551615 in row 3"),
    (np.ones(4), "labels: .*float64"),
    (np.ones(4, bool), "labels: .*bool"),
    (np.ones((4, 2)), r"labels: .* of shape \(4, 2\)"),
    (np.ones((4, 3), int), "labels: .*int64"),
    (np.ones((5, 3)) / 3, r"labels: .* of shape \(5, 3\)"),
    ([[1, 0, 0], [0.5, 0.6, -0.1], [0, 0, 0], [0, 0, 1.0]], "labels: -0.1.* in row 1"),
    ([[1, 0, 0], [0, 0, 0], [NAN, 0, 0], [0, 0, 1.0]], "labels: nan in row 2"),
    ([[1, 0, 0], [0, 0, 0], [0.5, 0.2, 0], [0, 0, 1.0]], "labels: a sum of 0.7.* in row 2"),
    ("road", "labels: "),
    ([None] * 4, "labels: .*object"),
]
BAD_POSES = [
    (np.eye(3), r"T_map_sensor: expected 4 x 4 .* of shape \(3, 3\)"),
    (np.eye(4)[:3], r"T_map_sensor: expected 4 x 4 real numbers, got float64 of shape \(3, 4\)"),
    (np.diag([1, 1, 1, NAN]), "T_map_sensor: nan in row 3"),
    (np.diag([1, INF, 1, 1]), "T_map_sensor: inf in row 1"),
    (np.diag([1, 1, -1, 1]), "no rotation"),
    (np.diag([2, 1, 1, 1]), "no rotation"),
    (np.diag([1, 1, 1, 2]), "last row"),
    ("pose", "T_map_sensor: "),
    (np.vstack([np.eye(4)[:3] + [0, 0, 0, 1e9], [0, 0, 0, 1]]), "outside"),
]


@pytest.fixture
def grown():
    return map_of_yard()


@pytest.mark.parametrize("points, said", NO_POINTS, ids=lambda value: None)
def test_what_are_no_points_is_refused(grown, points, said):
    before = grown.copy()
    for use in (grown.insert, grown.query, grown.distributions):
        with pytest.raises(ValueError, match=said):
            use(points)
    for use, name in ((lambda p: grown.cast_rays(p, POINTS), "origins"), (lambda p: grown.cast_rays(POINTS, p), "directions")):
        with pytest.raises(ValueError, match=said.replace("points", name)):
            use(points)
    assert grown == before


@pytest.mark.parametrize("labels, said", BAD_LABELS, ids=lambda value: None)
def test_labels_that_are_none_are_refused(grown, labels, said):
    before = grown.copy()
    with pytest.raises(ValueError, match=said):
        grown.insert(POINTS, labels)
    assert grown == before


@pytest.mark.parametrize("pose, said", BAD_POSES, ids=lambda value: None)
def test_poses_that_are_none_are_refused(grown, pose, said):
    before = grown.copy()
    with pytest.raises(ValueError, match=said):
        grown.insert(POINTS, None, pose)
    assert grown == before


@pytest.mark.parametrize("value", [NAN, INF, -INF])
@pytest.mark.parametrize("type", [np.float32, np.float64, np.float16])
def test_places_that_are_not_finite_are_named(grown, value, type):
    points = POINTS.astype(type)
    points[2, 1] = value
    for use in (grown.query, grown.distributions):
        with pytest.raises(ValueError, match=f"points: {value} in row 2, expected numbers that are finite"):
            use(points)
    with pytest.raises(ValueError, match=f"origins: {value} in row 2"):
        grown.cast_rays(points, POINTS)
    with pytest.raises(ValueError, match=f"directions: {value} in row 2"):
        grown.cast_rays(POINTS, points)
    with pytest.raises(ValueError, match=f"low: {value} in row 0"):
        grown.leaves(points[2], POINTS[3])


def test_returns_that_are_none_are_counted(grown):
    report = grown.insert([[1, 1, 1], [NAN, 0, 0], [0, INF, 0], [1e30, 0, 0], [1e300, 0, 0]])
    assert report["points"] == 5 and report["not_finite"] == 3 and report["outside"] == 1


def test_places_outside_of_the_map_are_unknown(grown):
    far = [[1e30, 0, 0], [1e300, 0, 0], [-1e300, 1e300, 0]]
    assert not grown.query(far)["known"].any()
    assert np.isnan(grown.distributions(far)).all()
    assert not grown.cast_rays(far, np.ones((3, 3)))["hit"].any()
    assert grown.cast_rays([[0, 0, 1]] * 2, [[0, 0, -1e-300], [0, 0, -1e300]])["hit"].all()


def layouts(array):
    yield array[::-1][::-1]
    yield np.asfortranarray(array)
    yield np.repeat(array, 2, 0)[::2]
    yield array.astype(array.dtype.newbyteorder())
    packed = np.zeros(len(array), [("byte", np.uint8), ("values", array.dtype, array.shape[1:])])
    packed["values"] = array
    yield packed["values"]  # not aligned
    yield array.tolist()
    readonly = array.copy()
    readonly.flags.writeable = False
    yield readonly


def test_arrays_of_any_layout_make_the_same_map():
    random = np.random.default_rng(5)
    points = random.integers(-500, 500, (1000, 3)) / 64  # exact in all types
    labels = random.integers(0, 4, 1000)
    expected = semantic_octree.Map(RESOLUTION, NAMES)
    expected.insert(points, labels)
    for type in (np.float16, np.float32, np.float64, np.longdouble):
        for array in layouts(points.astype(type)):
            other = semantic_octree.Map(RESOLUTION, NAMES)
            other.insert(array, labels)
            assert other == expected
            assert (other.query(array) == expected.query(points)).all()
    for type in (np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64):
        for array in layouts(labels.astype(type)):
            other = semantic_octree.Map(RESOLUTION, NAMES)
            other.insert(points, array)
            assert other == expected
    soft, by_soft = np.eye(4)[labels][:, 1:], semantic_octree.Map(RESOLUTION, NAMES)
    by_soft.insert(points, soft)
    for type in (np.float16, np.float32, np.float64):
        for array in layouts(soft.astype(type)):
            other = semantic_octree.Map(RESOLUTION, NAMES)
            other.insert(points, array)
            assert other == by_soft
    empty = expected.copy()
    empty.insert(np.zeros((0, 3)), np.zeros(0, int))
    assert empty == expected and len(expected.query(np.zeros((0, 3)))) == 0


def test_more_is_refused_that_is_wrong(grown, tmp_path):
    refused = [
        (lambda: semantic_octree.Map(0, NAMES), ValueError, "voxel size|resolution"),
        (lambda: semantic_octree.Map(0.1, []), ValueError, "class"),
        (lambda: semantic_octree.Map(0.1, ["a", 3]), ValueError, "3 is no name"),
        (lambda: semantic_octree.Map(0.1, 3), ValueError, "classes"),
        (lambda: semantic_octree.Map(0.1, ["a\ud800"]), ValueError, "not Unicode"),
        (lambda: grown.abstraction({"\ud800": 1}), ValueError, "not Unicode"),
        (lambda: semantic_octree.Map(0.1, {"a": (1, 2, 256)}), ValueError, "color of 'a'"),
        (lambda: semantic_octree.Map(0.1, {"a": "red"}), ValueError, "color of 'a'"),
        (lambda: semantic_octree.Map(0.1, tmp_path / "none.yaml"), RuntimeError, "none.yaml"),
        (lambda: semantic_octree.Map(0.1, NAMES, accuracy=2), ValueError, "accuracy"),
        (lambda: semantic_octree.Map(0.1, NAMES, acuracy=0.9), TypeError, "acuracy.*did you mean 'accuracy'"),
        (lambda: semantic_octree.Map.load(tmp_path / "none.semantic"), RuntimeError, "none.semantic"),
        (lambda: grown.save(tmp_path / "none" / "a.semantic"), RuntimeError, "none"),
        (lambda: grown.to_octomap(tmp_path / "a.pcd"), ValueError, "a.pcd"),
        (lambda: grown.insert(POINTS, max_range=-1), ValueError, "max_range is -1"),
        (lambda: grown.age(NAN), ValueError, ""),
        (lambda: grown.cast_rays(POINTS, POINTS[:2]), ValueError, "directions: 2 rows for 4"),
        (lambda: grown.cast_rays(POINTS, np.zeros((4, 3))), ValueError, "directions: all 0 in row 0"),
        (lambda: grown.cast_rays(POINTS, POINTS + 1, max_range=NAN), ValueError, "max_range"),
        (lambda: grown.leaves([0, 0, 0]), ValueError, "low, high"),
        (lambda: grown.leaves([1, 0, 0], [0, 0, 0]), ValueError, "low"),
        (lambda: grown.leaves([1, 0], [0, 0, 0]), ValueError, "low: expected 3"),
        (lambda: grown.abstraction({"rod": 1}), ValueError, "'rod'"),
        (lambda: grown.abstraction({"road": "much"}), ValueError, "'much'"),
        (lambda: grown.abstraction(["road"]), ValueError, "weights"),
        (lambda: grown.abstraction({"road": 1}, blok_size=1), TypeError, "block_size"),
        (lambda: grown.abstraction({"road": 1}).leaves(alpha=1, leaves=1), ValueError, "one of them"),
        (lambda: grown.abstraction({"road": 1}).leaves(leaves=1), ValueError, "leaves"),
        (lambda: grown.plan((0, 0), (1, 1, 0), ["road"]), ValueError, "start: expected 3"),
        (lambda: grown.plan((0, 0, NAN), (1, 1, 0), ["road"]), ValueError, "start: nan"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), ["rod"]), ValueError, "'rod'"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), ["road"], rates=[1]), ValueError, "rate"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), ["road"], {"height": -1}), ValueError, "height"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), ["road"], {"heigt": 1}), TypeError, "heigt"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), ["road"], {"footprint": 3}), ValueError, "footprint"),
        (lambda: grown.plan((0, 0, 0), (1, 1, 0), tmp_path / "none.yaml"), RuntimeError, "none.yaml"),
    ]
    before = grown.copy()
    for number, (action, error, said) in enumerate(refused):
        with pytest.raises(error, match=said):
            action()
            print("not refused:", number)
    assert grown == before
    assert not list(tmp_path.iterdir())
