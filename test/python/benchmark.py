"""Times the Python package on a sequence of SemanticKITTI: benchmark.py SEQUENCE_DIR [RESOLUTION [TURNS]].

Prints processor seconds: the least of so many turns."""
import pathlib
import sys
import time

import numpy as np

import semantic_octree

QUERIES = 1_000_000


def scans_of(folder):
    """Points (N x 3, float32), raw labels (N, uint16) and poses of the sensor."""
    calibration = dict(line.split(":", 1) for line in (folder / "calib.txt").read_text().splitlines() if ":" in line)
    homogeneous = lambda numbers: np.vstack([np.reshape(numbers, (3, 4)), [0, 0, 0, 1]])
    T_camera_lidar = homogeneous(np.fromstring(calibration["Tr"], sep=" "))
    poses = np.loadtxt(folder / "poses.txt")
    for file, pose in zip(sorted((folder / "velodyne").glob("*.bin")), poses):
        points = np.fromfile(file, np.float32).reshape(-1, 4)[:, :3]
        labels = np.fromfile(folder / "labels" / (file.stem + ".label"), np.uint32) & 0xFFFF
        yield points, labels, np.linalg.inv(T_camera_lidar) @ homogeneous(pose) @ T_camera_lidar


def least(turns, action):
    seconds = []
    for _ in range(turns):
        begin = time.process_time()
        result = action()
        seconds.append(time.process_time() - begin)
    return min(seconds), result


def main(folder, resolution=0.2, turns=5):
    scans = list(scans_of(folder))
    raw_ids = np.unique(np.concatenate([labels for _, labels, _ in scans]))
    names = [f"raw id {i}" for i in raw_ids if i != 0]
    class_of = np.cumsum(np.isin(np.arange(raw_ids[-1] + 1), raw_ids[raw_ids != 0])) * (np.arange(raw_ids[-1] + 1) > 0)
    scans = [(points, class_of[labels].astype(np.uint8), T) for points, labels, T in scans]

    def insert_all():
        new = semantic_octree.Map(resolution, names)
        for scan in scans:
            new.insert(*scan)
        return new

    seconds, grown = least(turns, insert_all)
    print(f"insert   {sum(len(p) for p, _, _ in scans)} points: {seconds:.3f} s, {len(grown)} leaves")
    random = np.random.default_rng(1)
    low, high = grown.bounds()
    anywhere = random.uniform(low, high, (QUERIES, 3))
    near = np.concatenate([p @ T[:3, :3].T + T[:3, 3] for p, _, T in scans])
    for name, points in (("anywhere", anywhere), ("of scans", random.choice(near, QUERIES))):
        seconds, cells = least(turns, lambda: grown.query(points))
        print(f"query    {QUERIES} points {name}: {seconds:.3f} s, {cells['known'].mean():.0%} known")
    seconds, leaves = least(turns, grown.leaves)
    print(f"leaves   {len(leaves)}: {seconds:.3f} s")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), *(float(a) for a in sys.argv[2:3]), *(int(a) for a in sys.argv[3:4]))
