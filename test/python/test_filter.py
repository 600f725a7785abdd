"""The map against the filter's formulas, counted in numpy, and against the programs."""
import numpy as np
import pytest

import semantic_octree
from support import NAMES, RESOLUTION, program

ACCURACY, HIT, FALSE_ALARM, LEAST_OCCUPANCY, LARGEST = 0.93, 0.5, 0.03, 0.12, 0.97  # FilterParameters' values
ROUNDING = 0.004  # of log-odds on the filter's grid


def logit(p):
    return np.log(p / (1 - p))


def after_hit(h, label):
    """Log-odds of K classes against free space, after a return; label 0: none."""
    K = len(h)
    ratio = HIT / FALSE_ALARM
    other = ratio if label == 0 else ratio * (1 - ACCURACY) * K / (K - 1)
    h = h + np.log(other)
    if label:
        h[label - 1] += np.log(ratio * ACCURACY * K) - np.log(other)
    return h


def limited(h):
    K = len(h)
    h = h - max(0, h.max() - logit(LARGEST))
    return np.maximum(h, logit(LEAST_OCCUPANCY) - np.log(K))


def probabilities(h):
    p = np.exp(np.concatenate([[0], h]))
    return p / p.sum()


@pytest.mark.parametrize("seed", range(5))
def test_single_beams_along_axes_make_the_distributions_of_the_formulas(seed):
    random = np.random.default_rng(seed)
    K, reach = 5, 8
    grown = semantic_octree.Map(RESOLUTION, [f"class {k}" for k in range(1, K + 1)])
    expected = {}
    for _ in range(60):
        axis, sign, steps, label = random.integers(3), random.choice([-1, 1]), random.integers(1, reach), random.integers(4)
        direction = np.zeros(3, int)
        direction[axis] = sign
        grown.insert([direction * steps * RESOLUTION], [label], np.block([[np.eye(3), np.full((3, 1), RESOLUTION / 2)],
                                                                         [np.zeros(3), 1]]))
        for step in range(steps + 1):
            h = expected.get(tuple(direction * step), np.full(K, -np.log(K)))
            h = after_hit(h, label) if step == steps else h + np.log((1 - HIT) / (1 - FALSE_ALARM))
            expected[tuple(direction * step)] = limited(h)
    voxels = np.array(list(expected))
    centers = (voxels + 0.5) * RESOLUTION
    truth = np.array([probabilities(h) for h in expected.values()])
    assert np.abs(grown.distributions(centers) - truth).max() < ROUNDING
    cells = grown.query(centers)
    assert cells["known"].all()
    assert np.abs(cells["occupancy"] - (1 - truth[:, 0])).max() < ROUNDING
    named = cells["classes"][:, 0] > 0
    assert named.sum() > 5
    best = truth[np.arange(len(truth)), cells["classes"][:, 0]]
    assert np.abs(cells["probabilities"][:, 0] - best)[named].max() < ROUNDING
    assert (best >= truth[:, 1:].max(1) - ROUNDING)[named].all()
    assert len(grown) == len(voxels) or grown.leaves()["size"].max() > RESOLUTION  # nothing else is known
    assert not grown.query(centers + [0, 0, 100 * RESOLUTION])["known"].any()


def test_soft_labels_add_their_logarithms():
    soft = np.array([[0.7, 0.2, 0.1]], np.float32)
    grown = semantic_octree.Map(RESOLUTION, NAMES)
    grown.insert([[1.1, 0.1, 0.1]], soft, None)
    h = limited(np.full(3, -np.log(3)) + np.log(HIT / FALSE_ALARM * 3 * soft[0]))
    assert np.abs(grown.distributions([[1.1, 0.1, 0.1]])[0] - probabilities(h)).max() < ROUNDING
    nobody_knows = semantic_octree.Map(RESOLUTION, NAMES)
    nobody_knows.insert([[1.1, 0.1, 0.1]], np.zeros((1, 3)))
    assert nobody_knows.query([[1.1, 0.1, 0.1]])["classes"].max() == 0


def write_pcd(file, points, labels, viewpoint):
    """Points in the world's frame."""
    rows = np.zeros(len(points), [("p", "<f4", 3), ("label", "<u4")])
    rows["p"], rows["label"] = points, labels
    x, y, z = viewpoint
    head = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {len(rows)}\n"
            f"HEIGHT 1\nVIEWPOINT {x} {y} {z} 1 0 0 0\nPOINTS {len(rows)}\nDATA binary\n")
    file.write_bytes(head.encode() + rows.tobytes())


def test_the_map_is_that_of_the_program_bit_for_bit(tmp_path):
    random = np.random.default_rng(7)
    table = tmp_path / "classes.yaml"
    table.write_text("no_class: [0]\nclasses:\n" + "".join(f"  - {{id: {i}, name: {name}, color: [{i}, 0, 0], raw: [{i}]}}\n"
                                            for i, name in enumerate(NAMES, 1)))
    grown = semantic_octree.Map(0.2, table)
    files = []
    for number in range(4):
        position = np.array([number, 0.5 * number, 1])  # these numbers are exact, as are differences of them
        points = (random.integers(-2000, 2000, (5000, 3)) / 256).astype(np.float32)
        labels = random.integers(0, 4, 5000)
        files.append(tmp_path / f"{number}.pcd")
        write_pcd(files[-1], points + position, labels, position)
        T = np.eye(4)
        T[:3, 3] = position
        grown.insert(points, labels, T)
    program("dataset2rawlog", "pcd", "--classes", table, *files, "-o", tmp_path / "scans.rawlog")
    program("rawlog2semantic-map", "--classes", table, "--resolution", 0.2, "--output", tmp_path / "map", tmp_path / "scans.rawlog")
    assert semantic_octree.Map.load(tmp_path / "map" / "map.semantic") == grown


def test_maps_come_back_from_files_pickles_and_copies(tmp_path):
    import copy
    import pickle
    from support import map_of_yard

    grown = map_of_yard()
    grown.save(tmp_path / "a.semantic")
    others = [semantic_octree.Map.load(str(tmp_path / "a.semantic")), pickle.loads(pickle.dumps(grown)), grown.copy(),
              copy.deepcopy(grown)]
    for other in others:
        assert other == grown and other.classes == NAMES
    grown.insert([[1, 1, 1.0]])
    assert all(other != grown for other in others)
    grown.clear()
    assert len(grown) == 0 and grown.bounds() is None


def test_octomap_files_are_those_of_the_program(tmp_path):
    from support import map_of_yard

    grown = map_of_yard()
    grown.save(tmp_path / "a.semantic")
    for name in ("a.bt", "a.ot"):
        program("semantic-map-export", tmp_path / "a.semantic", "-o", tmp_path / ("program-" + name))
        grown.to_octomap(tmp_path / name)
        assert (tmp_path / name).read_bytes() == (tmp_path / ("program-" + name)).read_bytes()
    grown.to_octomap(tmp_path / "plain.ot", colors=False)
    assert b"id OcTree\n" in (tmp_path / "plain.ot").read_bytes()
