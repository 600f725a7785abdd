#pragma once
#include <strict_files/OptionList.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <set>
#include <string>

namespace strict_files {

/** A text as YAML files have it, also in flow style: in quotes where it needs them. */
std::string yamlText(const std::string& text);

/** A YAML file whose every key and value is checked. All functions throw std::runtime_error with
 * file, line, and what was expected. */
class StrictYaml {
 public:
  /** Reads the file: yaml-cpp's parser, because MRPT's stops at a syntax error in silence. */
  explicit StrictYaml(const std::filesystem::path& file);
  /** Reads a text. \param name What messages call it, in place of a file. */
  StrictYaml(const std::string& text, const std::string& name);

  const YAML::Node& root() const { return m_root; }
  [[noreturn]] void fail(const YAML::Node& where, const std::string& what) const;

  /** The node is a map with these keys only, each at most once. */
  void checkKeys(const YAML::Node& map, const std::set<std::string>& known) const;
  /** Reads the options that are in a map; the elements of a list are joined by ", ". Other keys are
   * for checkKeys(), which wants OptionList::names() beside those that it knows otherwise. */
  void read(const YAML::Node& map, const OptionList& list) const;
  /** The node is a map without a key twice. */
  void checkMap(const YAML::Node& map) const;
  void checkList(const YAML::Node& list, const std::string& field) const;
  YAML::Node required(const YAML::Node& map, const std::string& key) const;

  /** A whole number that fits. \param expected What to say if it is none: "a class id". */
  template <typename T>
  T value(const YAML::Node& node, const std::string& expected) const {
    using Limits = std::numeric_limits<T>;
    static_assert(Limits::is_integer);
    return static_cast<T>(whole(node, expected, static_cast<double>(Limits::lowest()),
                                static_cast<double>(Limits::max())));
  }
  std::string text(const YAML::Node& node, const std::string& field) const;
  /** A finite number. */
  double number(const YAML::Node& node, const std::string& field) const;
  double notNegative(const YAML::Node& node, const std::string& field) const;
  /** [x, y, z] */
  Eigen::Vector3d point(const YAML::Node& node, const std::string& field) const;

 private:
  double whole(const YAML::Node& node, const std::string& expected, double low, double high) const;
  static std::string quoted(const YAML::Node& node);
  [[noreturn]] void fail(const YAML::Mark& where, const std::string& what) const;
  void parse(const std::string& text);

  std::string m_file;
  YAML::Node m_root;
};

}  // namespace strict_files
