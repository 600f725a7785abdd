#pragma once
#include <strict_files/OptionList.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

/** As all programs write it: two spaces a level, and a line's end. Bytes that are no UTF-8 (names
 * of files may be) become U+FFFD. */
std::string textOf(const nlohmann::json& json);
std::string textOf(const nlohmann::ordered_json& json);

/** The values of options: numbers, booleans, else texts; block_size is "blockSize". */
nlohmann::ordered_json jsonOf(const strict_files::OptionList& options);

/** Writes it into a file. \throw std::runtime_error naming the file: it cannot be written. */
void writeJson(const std::filesystem::path& file, const nlohmann::json& json);
void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& json);
