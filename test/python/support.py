"""What the tests of the Python package share."""
import os
import pathlib
import subprocess

import numpy as np

import semantic_octree

RESOLUTION = 0.25  # m: borders of voxels are exact
NAMES = ["road", "grass", "wall"]
ROAD, GRASS, WALL = 1, 2, 3


def program(name, *arguments):
    """Runs a program of this project. Raises what it says if it fails."""
    file = pathlib.Path(os.environ["MSO_BIN_DIR"]) / name
    done = subprocess.run([file, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def pose(x, y, z, heading=0.0):
    T = np.eye(4)
    T[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
    T[:3, 3] = x, y, z
    return T


def yard(seed=0):
    """Scans (points, labels, T_map_sensor) of a road in grass that ends at a wall, seen from 1.5 m above it."""
    random = np.random.default_rng(seed)
    for x in (-6.0, -2.0, 2.0):
        ground = np.column_stack([random.uniform(-8, 10, (8000, 2)), np.full(8000, 0.1)])
        wall = np.column_stack([np.full(2000, 10.1), random.uniform(-8, 8, 2000), random.uniform(0, 3, 2000)])
        labels = np.concatenate([np.where(abs(ground[:, 1]) < 2.5, ROAD, GRASS), np.full(2000, WALL)])
        T = pose(x, 0, 1.5, 0.1 * x)
        points = (np.concatenate([ground, wall]) - T[:3, 3]) @ T[:3, :3]
        yield points, labels, T


def map_of_yard():
    grown = semantic_octree.Map(RESOLUTION, NAMES)
    for scan in yard():
        grown.insert(*scan)
    return grown


def voxels_of(leaves):
    """Centers of all voxels in the leaves, and the number of the leaf that each lies in."""
    centers, owners = [], []
    for number, leaf in enumerate(leaves):
        edge = int(round(leaf["size"] / RESOLUTION))
        steps = (np.arange(edge) + 0.5) * RESOLUTION - leaf["size"] / 2
        grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), -1).reshape(-1, 3)
        centers.append(leaf["center"] + grid)
        owners.append(np.full(len(grid), number))
    return np.concatenate(centers), np.concatenate(owners)
