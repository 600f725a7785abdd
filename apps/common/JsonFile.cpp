#include "JsonFile.h"

#include <strict_files/TextFile.h>

#include <cctype>

namespace {

template <class Json>
std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string camelCase(const std::string& name) {
  std::string word;
  for (std::size_t i = 0; i < name.size(); ++i)
    if (name[i] == '_' && i + 1 < name.size())
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(name[++i])));
    else
      word += name[i];
  return word;
}

}  // namespace

nlohmann::ordered_json jsonOf(const strict_files::OptionList& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const strict_files::Option& option : options.options()) {
    const std::string text = option.text();
    const auto value = nlohmann::ordered_json::parse(text, nullptr, false);
    const bool isText = !value.is_number() && !value.is_boolean();
    json[camelCase(option.name)] = isText ? nlohmann::ordered_json(text) : value;
  }
  return json;
}

std::string textOf(const nlohmann::json& json) { return dumped(json); }
std::string textOf(const nlohmann::ordered_json& json) { return dumped(json); }

void writeJson(const std::filesystem::path& file, const nlohmann::json& json) {
  strict_files::writeText(file, dumped(json));
}
void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  strict_files::writeText(file, dumped(json));
}
