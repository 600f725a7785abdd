"""The report of a city: one HTML file, what is missing, and how long everything took. Run by the Snakefile."""
import csv
import html
import json
from pathlib import Path

OF_RAWLOGS = ["map", "cut"]
STEPS = OF_RAWLOGS + ["sum", "compress"]


def size(path):
    """Bytes of a file, or of all in a folder."""
    path = Path(path)
    return sum(file.stat().st_size for file in (path.rglob("*") if path.is_dir() else [path]) if file.is_file())


def megabytes(count):
    return f"{count / 1e6:.1f}"


def table(header, rows):
    def line(tag, cells):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>\n"

    return "<table>\n" + line("th", header) + "".join(line("td", row) for row in rows) + "</table>\n"


def problems(city, rawlogs):
    """Of each rawlog that could not be used, or not all of it: whether there is a map, and what its program said."""
    found = {}
    for drive in rawlogs:
        file = city / "maps" / drive / "problem.txt"
        if file.exists():
            found[drive] = ((file.parent / "map.semantic").exists(), file.read_text(errors="replace").strip())
    return found


def times_of(city, step, names):
    """Jobs of a step: number, seconds of all, of the longest, largest memory in MB."""
    rows = []
    for name in names:
        with open(city / "times" / step / f"{name}.tsv", newline="") as lines:
            rows += list(csv.DictReader(lines, delimiter="\t"))
    seconds = [float(row["s"]) for row in rows]
    memory = [float(row["max_rss"]) for row in rows if row["max_rss"] not in ("-", "NA")]
    return [step, len(rows), f"{sum(seconds):.1f}", f"{max(seconds, default=0):.1f}", f"{max(memory, default=0):.0f}"]


def tile_rows(city, tiles):
    rows = []
    for tile, drives in tiles.items():
        with open(city / "compressed" / tile / "report.json") as report:
            measures = json.load(report)
        solutions = measures["solutions"]
        rows.append([tile, len(drives), measures["map"]["tree"]["knownLeaves"], measures["map"]["fileBytes"]] +
                    [solution["fileBytes"] for solution in solutions])
    names = [solution["name"] for solution in solutions] if tiles else []
    return ["tile", "drives", "leaves", "bytes"] + [f"bytes, {name}" for name in names], rows


def plan(tiles):
    """The tiles from above, +y up: each leads to its picture, and is as dark as it was met often."""
    if not tiles:
        return ""
    places = {tile: [int(number) for number in tile.split("_")] for tile in tiles}
    left, top = min(x for x, _ in places.values()), max(y for _, y in places.values())
    width = max(x for x, _ in places.values()) - left + 1
    height = top - min(y for _, y in places.values()) + 1
    most = max(len(drives) for drives in tiles.values())
    squares = "".join(
        f'<a href="compressed/{tile}/tile.png"><rect x="{x - left}" y="{top - y}" width="1" height="1" fill="#357" '
        f'fill-opacity="{0.2 + 0.8 * len(tiles[tile]) / most:.2f}"><title>{tile}: {len(tiles[tile])} drives</title>'
        "</rect></a>\n" for tile, (x, y) in places.items())
    return f'<svg viewBox="0 0 {width} {height}" width="{min(900, 40 * width)}">\n{squares}</svg>\n'


def page(city, rawlogs, tiles, edge):
    trouble = problems(city, rawlogs)
    missing = [drive for drive, (has_map, _) in trouble.items() if not has_map]
    pieces = sum(len(drives) for drives in tiles.values())
    sizes = [["rawlogs", len(rawlogs), megabytes(sum(map(size, rawlogs.values())))]]
    sizes += [[name, count, megabytes(size(city / folder))]
              for name, count, folder in [("maps, with pictures", len(rawlogs) - len(missing), "maps"),
                                          ("pieces of maps", pieces, "pieces"), ("tiles", len(tiles), "tiles"),
                                          ("compressed tiles, with pictures", len(tiles), "compressed")]]
    parts = [f"<h1>{html.escape(city.name)}</h1>\n<p>{len(rawlogs) - len(missing)} of {len(rawlogs)} rawlogs, "
             f"{len(tiles)} tiles of {edge} m, {pieces} pieces.</p>\n"]
    if trouble:
        parts += ["<h2>Rawlogs with problems</h2>\n",
                  table(["rawlog", "map", "what its program said"],
                        [[drive, "in part" if has_map else "none", text] for drive, (has_map, text) in trouble.items()])]
    parts += [plan(tiles), "<h2>Sizes</h2>\n", table(["what", "number", "MB"], sizes),
              "<h2>Times</h2>\n", table(["step", "jobs", "s", "longest, s", "most memory, MB"],
                                        [times_of(city, step, rawlogs if step in OF_RAWLOGS else tiles)
                                         for step in STEPS]),
              "<h2>Tiles</h2>\n", table(*tile_rows(city, tiles))]
    style = "body{font-family:sans-serif} table{border-collapse:collapse} td,th{border:1px solid #ccc;padding:2px 6px}"
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(city.name)}</title>'
            f"<style>{style}</style></head><body>\n" + "".join(parts) + "</body></html>\n")


def main(job):
    city, rawlogs = Path(job.params.city), job.params.rawlogs
    tiles = json.loads(Path(job.input.shuffle).read_text())
    lines = [f"{drive}\t{text}\n" for drive, (has_map, text) in problems(city, rawlogs).items() if not has_map]
    Path(job.output.missing).write_text("".join(lines))
    Path(job.output.report).write_text(page(city, rawlogs, tiles, job.params.tile))


main(snakemake)  # noqa: F821
