#include <labeled_cloud/NetworkLabeler.h>
#include <strict_files/StrictYaml.h>

#include <stdexcept>

#include "NamedClasses.h"

namespace labeled_cloud {

using semantic_types::ClassTable;

namespace {

std::set<std::string> knownKeys() {
  std::set<std::string> keys = {"input", "output", "batch"};
  keys.insert(kNamedClassesKeys.begin(), kNamedClassesKeys.end());
  return keys;
}

/** Three numbers, one for each channel. */
void readChannels(const strict_files::StrictYaml& yaml, const YAML::Node& node,
                  const std::string& field, std::array<double, 3>& values) {
  if (!node) return;
  const Eigen::Vector3d found = yaml.point(node, field);
  values = {found[0], found[1], found[2]};
}

void readInput(const strict_files::StrictYaml& yaml, const YAML::Node& node,
               NetworkOptions& options) {
  yaml.checkKeys(node, {"width", "height", "fit", "channels", "scale", "mean", "std", "name"});
  options.width = yaml.value<int>(yaml.required(node, "width"), "width: pixels");
  options.height = yaml.value<int>(yaml.required(node, "height"), "height: pixels");
  using Fit = NetworkOptions::Fit;
  using Channels = NetworkOptions::Channels;
  if (node["fit"])
    options.fit =
        yaml.choice<Fit>(node["fit"], "fit", {{"stretch", Fit::Stretch}, {"width", Fit::Width}});
  if (node["channels"])
    options.channels = yaml.choice<Channels>(node["channels"], "channels",
                                             {{"rgb", Channels::Rgb}, {"bgr", Channels::Bgr}});
  if (node["scale"]) options.scale = yaml.number(node["scale"], "scale");
  readChannels(yaml, node["mean"], "mean", options.mean);
  readChannels(yaml, node["std"], "std", options.deviation);
  if (node["name"]) options.input = yaml.text(node["name"], "name");
}

void readOutput(const strict_files::StrictYaml& yaml, const YAML::Node& node,
                NetworkOptions& options) {
  if (!node) return;
  yaml.checkKeys(node, {"name", "content", "labels", "min_confidence"});
  using Content = NetworkOptions::Content;
  using Labels = NetworkOptions::Labels;
  if (node["name"]) options.output = yaml.text(node["name"], "name");
  if (node["content"])
    options.content = yaml.choice<Content>(node["content"], "content",
                                           {{"scores", Content::Scores},
                                            {"probabilities", Content::Probabilities},
                                            {"ids", Content::Ids}});
  if (node["labels"])
    options.labels = yaml.choice<Labels>(
        node["labels"], "labels", {{"softmax", Labels::Softmax}, {"argmax", Labels::Argmax}});
  if (node["min_confidence"])
    options.minConfidence = yaml.number(node["min_confidence"], "min_confidence");
}

}  // namespace

NetworkOptions loadNetworkOptions(const std::filesystem::path& file, const ClassTable& table) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), knownKeys());
  NetworkOptions options;
  readInput(yaml, yaml.required(yaml.root(), "input"), options);
  readOutput(yaml, yaml.root()["output"], options);
  if (const YAML::Node batch = yaml.root()["batch"])
    options.batch = yaml.value<int>(batch, "batch: a number of images");
  options.classes = namedClasses(yaml, table);
  try {
    options.validate();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
  return options;
}

}  // namespace labeled_cloud
