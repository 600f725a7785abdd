"""Compresses a map to the leaves that tell most about the road: 2_compress.py MAP.semantic"""
import sys

from semantic_octree import Map

semantic_map = Map.load(sys.argv[1])
abstraction = semantic_map.abstraction({"road": 1.0, "grass": -0.1})
leaves = abstraction.leaves(leaves=3000)
kept = abstraction.retention()["road"]
print(f"{len(leaves)} of {len(semantic_map)} leaves, of {leaves['size'].min()} to {leaves['size'].max()} m, keep {kept:.0%}")
