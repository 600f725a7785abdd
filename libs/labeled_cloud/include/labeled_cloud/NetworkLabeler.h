#pragma once
#include <labeled_cloud/LabelImage.h>

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace labeled_cloud {

/** What a segmentation network expects and answers. */
struct NetworkOptions {
  enum class Fit {
    /** The picture is stretched to the input's size. */
    Stretch,
    /** The picture is scaled to the input's width. If it is then higher than the input, its top
     * rows are cut off; if lower, its last row is repeated below. */
    Width
  };
  enum class Channels { Rgb, Bgr };
  enum class Content {
    Scores,         ///< a plane for each class; softmax makes them probabilities
    Probabilities,  ///< a plane for each class
    Ids             ///< one plane, numbers of `classes` from 0
  };

  /** The input in pixels. */
  int width = 0, height = 0;
  Fit fit = Fit::Stretch;
  Channels channels = Channels::Rgb;
  /** Each channel of the input is (value - mean) / deviation, value 0..1; in the order of
   * `channels`. */
  Eigen::Vector3d mean{0, 0, 0}, deviation{1, 1, 1};
  /** Name of the layer that answers; may be empty if there is only one. */
  std::string output;
  Content content = Content::Scores;
  /** The class of each of the network's channels, kNoClass for those that mean none. Several may
   * have the same class. */
  std::vector<semantic_types::ClassId> classes;

  /** The options of the file's sections `input` and `output`. */
  void describeInput(strict_files::OptionList& list);
  void describeOutput(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};
inline strict_files::Choices<NetworkOptions::Fit> choicesOf(NetworkOptions::Fit) {
  return {{"stretch", NetworkOptions::Fit::Stretch}, {"width", NetworkOptions::Fit::Width}};
}
inline strict_files::Choices<NetworkOptions::Channels> choicesOf(NetworkOptions::Channels) {
  return {{"rgb", NetworkOptions::Channels::Rgb}, {"bgr", NetworkOptions::Channels::Bgr}};
}
inline strict_files::Choices<NetworkOptions::Content> choicesOf(NetworkOptions::Content) {
  using Content = NetworkOptions::Content;
  return {{"scores", Content::Scores},
          {"probabilities", Content::Probabilities},
          {"ids", Content::Ids}};
}

/** Reads options from a YAML file, see doc/handbook/labels.md and config/networks/.
 * \throw std::runtime_error naming file, line and what was expected; a class that the table lacks
 * is named, too. */
NetworkOptions loadNetworkOptions(const std::filesystem::path& file,
                                  const semantic_types::ClassTable& table);

/** A segmentation network (ONNX) that labels the color images of observations: with class
 * probabilities, or with classes if it answers ids. */
class NetworkLabeler : public ImageLabeler {
 public:
  /** \param numClasses Of the class table.
   * \throw std::runtime_error naming the file: there is none, or OpenCV cannot read it. */
  NetworkLabeler(const std::filesystem::path& model, int numClasses, const NetworkOptions& options);
  ~NetworkLabeler() override;

  /** \throw std::runtime_error the observation's image cannot be read; or naming the network: it
   * answers something else than the options say, as another number of classes. */
  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override;

 private:
  struct Network;
  std::unique_ptr<Network> m_network;
};

}  // namespace labeled_cloud
