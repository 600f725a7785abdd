#include "JsonFile.h"

#include <strict_files/TextFile.h>

namespace {

template <class Json>
std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string textOf(const nlohmann::json& json) { return dumped(json); }
std::string textOf(const nlohmann::ordered_json& json) { return dumped(json); }

void writeJson(const std::filesystem::path& file, const nlohmann::json& json) {
  strict_files::writeText(file, dumped(json));
}
void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  strict_files::writeText(file, dumped(json));
}
