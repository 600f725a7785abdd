#include <labeled_cloud/NetworkLabeler.h>
#include <strict_files/StrictYaml.h>

#include <stdexcept>

#include "NamedClasses.h"

namespace labeled_cloud {

using semantic_types::ClassTable;
using strict_files::above;
using strict_files::atLeast;
using strict_files::between;
using strict_files::Choices;
using strict_files::OptionList;
using strict_files::require;

namespace {

std::set<std::string> knownKeys() {
  std::set<std::string> keys = {"input", "output", "batch"};
  keys.insert(kNamedClassesKeys.begin(), kNamedClassesKeys.end());
  return keys;
}

/** Reads a map whose keys are the options of a list. */
void readAll(const strict_files::StrictYaml& yaml, const YAML::Node& node,
             const strict_files::OptionList& list) {
  const std::vector<std::string> names = list.names();
  yaml.checkKeys(node, {names.begin(), names.end()});
  yaml.read(node, list);
}

}  // namespace

const Choices<NetworkOptions::Fit>& choicesOf(NetworkOptions::Fit) {
  using Fit = NetworkOptions::Fit;
  static const Choices<Fit> choices = {{"stretch", Fit::Stretch}, {"width", Fit::Width}};
  return choices;
}

const Choices<NetworkOptions::Channels>& choicesOf(NetworkOptions::Channels) {
  using Channels = NetworkOptions::Channels;
  static const Choices<Channels> choices = {{"rgb", Channels::Rgb}, {"bgr", Channels::Bgr}};
  return choices;
}

const Choices<NetworkOptions::Content>& choicesOf(NetworkOptions::Content) {
  using Content = NetworkOptions::Content;
  static const Choices<Content> choices = {{"scores", Content::Scores},
                                           {"probabilities", Content::Probabilities},
                                           {"ids", Content::Ids}};
  return choices;
}

const Choices<NetworkOptions::Labels>& choicesOf(NetworkOptions::Labels) {
  using Labels = NetworkOptions::Labels;
  static const Choices<Labels> choices = {{"softmax", Labels::Softmax}, {"argmax", Labels::Argmax}};
  return choices;
}

void NetworkOptions::describeInput(OptionList& list) {
  list.add("width", width, "pixels", atLeast(1), "of the input; must be given");
  list.add("height", height, "pixels", atLeast(1), "of the input; must be given");
  list.add("fit", fit, "",
           "stretch: to the input's size; width: scaled to its width, top rows are cut off, or the "
           "last row is repeated below");
  list.add("channels", channels, "", "their order");
  list.add("scale", scale, "", above(0), "each channel is (value * scale - mean) / std");
  list.add("mean", mean, "", "of each channel");
  list.add("std", deviation, "", "of each channel, above 0");
  list.add("name", input, "", "of the layer; may be left out if there is only one");
}

void NetworkOptions::describeOutput(OptionList& list) {
  list.add("name", output, "", "of the layer; may be left out if there is only one");
  list.add("content", content, "",
           "a plane of scores or of probabilities for each class, or one of numbers of `classes` "
           "from 0");
  list.add("labels", labels, "", "class probabilities, or the likeliest class");
  list.add("min_confidence", minConfidence, "", between(0, 1), "pixels less sure have no class");
}

void NetworkOptions::describe(OptionList& list) {
  list.add("batch", batch, "", atLeast(1),
           "images that go through the network at once, where so many are waiting");
}

void NetworkOptions::validate() const {
  NetworkOptions copy = *this;
  OptionList inputs, outputs, others;
  copy.describeInput(inputs);
  copy.describeOutput(outputs);
  copy.describe(others);
  for (const OptionList* list : {&inputs, &outputs, &others}) checkAll(*list, "NetworkOptions");
  for (const double d : deviation) require(d > 0, "NetworkOptions::std", d, "a number above 0");
  require(!classes.empty(), "number of classes", 0, "1 or more");
}

NetworkOptions loadNetworkOptions(const std::filesystem::path& file, const ClassTable& table) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), knownKeys());
  NetworkOptions options;
  OptionList inputs, outputs, others;
  options.describeInput(inputs);
  options.describeOutput(outputs);
  options.describe(others);
  const YAML::Node input = yaml.required(yaml.root(), "input");
  readAll(yaml, input, inputs);
  for (const char* key : {"width", "height"}) yaml.required(input, key);
  if (const YAML::Node output = yaml.root()["output"]) readAll(yaml, output, outputs);
  yaml.read(yaml.root(), others);
  options.classes = namedClasses(yaml, table);
  try {
    options.validate();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
  return options;
}

}  // namespace labeled_cloud
