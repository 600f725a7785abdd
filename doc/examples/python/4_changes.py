"""Tells what changes in a map, as a program must that shows it or sends it: 4_changes.py MAP.semantic"""
import sys

from semantic_octree import Map

semantic_map = Map.load(sys.argv[1])
reader = semantic_map.follow()
print("at first", len(reader.tiles()[1]), "tiles")
semantic_map.insert([[4, 1, -1.0]], [2])
everything, tiles = reader.tiles()
for corner in tiles:
    print("tile at", corner, "has", len(semantic_map.leaves(corner, corner + 0.9 * reader.tile_size)), "leaves now")
