#include "Wish.h"

#include <semantic_abstraction/AbstractionOptions.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace radio {

using semantic_octree::Datagram;

namespace {

/** Behind a datagram's header and two bytes: which part this is, and how many there are. */
constexpr std::size_t kMaxPart = semantic_octree::kMaxDatagramBytes - 14, kMaxParts = 255;

}  // namespace

semantic_octree::AbstractionOptions Wish::forClasses(const semantic_types::ClassTable& classes,
                                                     const std::string& name) const {
  if (weights.empty())
    throw std::runtime_error("no weights: neither the sender nor the receiver has --weights");
  const auto file = semantic_octree::weightsOfText(weights, name, classes);
  const semantic_octree::Solution& s = file.solution(solution);
  // The terms of semantic-map-compress, in its order: rounding decides no tie otherwise.
  semantic_octree::AbstractionOptions options = file.space;
  options.weights.terms = semantic_octree::TermCatalog(classes, {s}).weighedTerms(s, 0);
  options.weights.alpha = alpha.value_or(s.alpha.value_or(0));
  return options;
}

std::vector<Datagram> Wish::requests(std::uint32_t stream) const {
  nlohmann::json json = {{"weights", weights}, {"solution", solution}};
  if (alpha) json["alpha"] = *alpha;
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::size_t number = (text.size() + kMaxPart - 1) / kMaxPart;
  if (number > kMaxParts)
    throw std::runtime_error("weights of " + std::to_string(weights.size()) +
                             " bytes are too long to be sent");
  std::vector<Datagram> requests;
  for (std::size_t i = 0; i < number; ++i)
    requests.push_back({Datagram::Type::Request, stream,
                        std::string{static_cast<char>(i), static_cast<char>(number)} +
                            text.substr(i * kMaxPart, kMaxPart)});
  return requests;
}

std::optional<Wish> WishReader::add(const Datagram& request) {
  const std::string& bytes = request.payload;
  const std::size_t part = bytes.size() > 1 ? static_cast<unsigned char>(bytes[0]) : 0;
  const std::size_t number = bytes.size() > 1 ? static_cast<unsigned char>(bytes[1]) : 0;
  if (part >= number || (m_number != 0 && m_number != number))
    throw std::runtime_error("altered: a request that cannot be");
  m_number = number;
  m_parts[part] = bytes.substr(2);
  if (m_parts.size() < m_number) return std::nullopt;
  std::string text;
  for (const auto& [i, piece] : m_parts) text += piece;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto isText = [&json](const char* key) {
    return json.contains(key) && json[key].is_string();
  };
  if (!json.is_object() || !isText("weights") || !isText("solution"))
    throw std::runtime_error("altered: a request that cannot be");
  Wish wish{json["weights"], json["solution"], std::nullopt};
  if (json.contains("alpha") && json["alpha"].is_number()) wish.alpha = json["alpha"];
  return wish;
}

}  // namespace radio
