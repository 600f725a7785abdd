#pragma once
#include <semantic_types/ClassTable.h>

#include <filesystem>

namespace semantic_types {

/** Reads a class table from a YAML file:
 *
 *     unknown_raw_id: error        # or no_class; may be left out (error)
 *     no_class: [0, 1]             # raw ids of a data set that mean "no class"; may be left out
 *     free_half_life: 3600         # of free space, seconds; may be left out (never forgotten)
 *     classes:                     # ids 1..K without gaps, in any order
 *       - {id: 1, name: road, color: [128, 64, 128], raw: [40, 60]}  # raw may be left out
 *       - {id: 2, name: person, color: [220, 20, 60], half_life: 2}  # seconds; may be left out
 *
 * \throw std::runtime_error naming file, line and value: unreadable file, YAML syntax, unknown or
 * repeated or missing key, ids with gaps or twice, colors that are not 0..255, half-lives that are
 * not 0.001 to 1e9 seconds, a raw id or a name used twice. */
ClassTable loadClassTable(const std::filesystem::path& file);

/** Writes TABLE so that loadClassTable() reads the same table. The file is complete or untouched.
 * \throw std::runtime_error the file cannot be written. */
void saveClassTable(const ClassTable& table, const std::filesystem::path& file);

}  // namespace semantic_types
