#include "Wish.h"

#include <map_streams/MapStream.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "Seal.h"

namespace radio {

namespace {

/** Bytes of a wish, compressed: what a datagram's header and the cookie leave; and as it is. */
constexpr std::size_t kMaxPacked = semantic_octree::kMaxDatagramBytes - 12 - Cookies::kBytes,
                      kMaxText = 1 << 16;

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

std::string Wish::packed() const {
  nlohmann::json json = {{"weights", weights}, {"solution", solution}};
  if (alpha) json["alpha"] = *alpha;
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(&packed[0]), &size,
            reinterpret_cast<const Bytef*>(text.data()), text.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
  if (text.size() > kMaxText || packed.size() > kMaxPacked)
    throw std::runtime_error("weights of " + std::to_string(weights.size()) +
                             " bytes are too long to be sent: they have to fit into " +
                             std::to_string(kMaxPacked) +
                             " compressed, or to be the sender's own (--weights)");
  return packed;
}

Wish Wish::of(const std::string& packed) {
  const auto check = [](bool isSo) {
    if (!isSo) throw std::runtime_error("altered: a request that cannot be");
  };
  std::string text(kMaxText, '\0');
  uLongf size = text.size();
  check(uncompress(reinterpret_cast<Bytef*>(&text[0]), &size,
                   reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  text.resize(size);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto isText = [&json](const char* key) {
    return json.contains(key) && json[key].is_string();
  };
  check(json.is_object() && isText("weights") && isText("solution"));
  Wish wish{json["weights"], json["solution"], std::nullopt};
  if (json.contains("alpha") && json["alpha"].is_number()) wish.alpha = json["alpha"];
  return wish;
}

}  // namespace radio
