#pragma once
#include <labeled_cloud/ScanConverter.h>

namespace semantic_map {

/** A converter and what it was made for: it keeps the rays of the camera met last. */
struct CachedConverter {
  CachedConverter(const semantic_types::ClassTable& table_,
                  const labeled_cloud::ScanConverterOptions& options_)
      : table(table_), options(options_), converter(table_, options_) {}

  bool isFor(const semantic_types::ClassTable& t,
             const labeled_cloud::ScanConverterOptions& o) const {
    const auto &labels = o.labels, &known = options.labels;
    return o.decimation == options.decimation &&
           o.flyingPixelThreshold == options.flyingPixelThreshold &&
           o.occlusionParallax == options.occlusionParallax && labels.kind == known.kind &&
           labels.minConfidence == known.minConfidence && labels.confusion == known.confusion &&
           t == table;
  }

  semantic_types::ClassTable table;
  labeled_cloud::ScanConverterOptions options;
  labeled_cloud::ScanConverter converter;
};

}  // namespace semantic_map
