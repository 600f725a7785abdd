"""Makes a map of scans with labels, and asks it: 1_map_of_scans.py MAP.semantic"""
import sys

import numpy as np
from semantic_octree import Map

semantic_map = Map(0.2, ["road", "grass"])  # m
ground = np.random.default_rng(1).uniform(-10, 10, (200_000, 3))
ground[:, 2] = -1.45  # m, below the sensor
labels = np.where(abs(ground[:, 1]) < 3, 1, 2)  # the road leads along x
report = semantic_map.insert(ground, labels, T_map_sensor=np.eye(4), max_range=30)
cells = semantic_map.query([[5, 0, -1.5], [5, 6, -1.5], [5, 0, 1]])
print(report["hit_voxels"], "voxels were hit; classes", cells["classes"][:, 0], "probabilities", cells["probabilities"][:, 0])
semantic_map.save(sys.argv[1])
