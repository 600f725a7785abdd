#pragma once
#include <map_folders/MapFolder.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

namespace semantic_map_info {

/** All there is to say about a map but its voxels. \param path where it is */
nlohmann::ordered_json describe(semantic_octree::StoredMap& map, const std::filesystem::path& path);

/** Prints a description for people. \param description what describe() returned */
void printText(const std::string& name, const nlohmann::ordered_json& description,
               std::ostream& out);

}  // namespace semantic_map_info
