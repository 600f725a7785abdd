#pragma once
#include <labeled_cloud/LabelModel.h>
#include <map_operations/Calibrator.h>

#include "CountedLabels.h"
#include "DataSets.h"
#include "Evaluation.h"
#include "SharedData.h"
#include "label_noise/LabelNoise.h"

/** Even frames make a map, odd ones ask it. */
class SplitFrames {
 public:
  using LabelNoise = label_noise::LabelNoise;
  using Evaluation = semantic_map_evaluate::Evaluation;

  /** What the even frames' labels go through, and where to. */
  struct Options {
    double resolution = 0.2;
    LabelNoise noise{0, LabelNoise::Kind::Points, 1, 19};
    semantic_octree::FilterParameters filter;
    labeled_cloud::LabelModel model;
    bool calibrated = true;
  };

  SplitFrames(std::vector<LabeledFrame> all, const ClassTable& classes, Options options)
      : map(options.resolution, classes, options.filter), m_frames(std::move(all)) {
    semantic_octree::Calibrator calibrator(options.resolution, classes.size());
    forEachEven(options.noise, [&](const LabeledFrame& frame, semantic_types::LabeledCloud cloud) {
      options.model.apply(classes.size(), {}, cloud);
      if (options.calibrated) calibrator.add(cloud, frame.T_map_sensor);
      map.insert(cloud, frame.T_map_sensor);
    });
    if (options.calibrated) map.setCalibration(calibrator.fit(map));
  }

  /** Ten scans of a street of SemanticKITTI. */
  static SplitFrames street(const std::string& sequence, const Options& options) {
    const ClassTable table = shippedTable("semantic_kitti.yaml");
    return {readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table), table,
            options};
  }

  /** Calls f(frame, cloud with labels that are wrong). */
  template <typename F>
  void forEachEven(LabelNoise noise, const F& f) const {
    for (std::size_t i = 0; i < m_frames.size(); i += 2) {
      semantic_types::LabeledCloud cloud = m_frames[i].cloud;
      noise.apply(cloud, m_frames[i].T_map_sensor);
      f(m_frames[i], std::move(cloud));
    }
  }

  /** Calls f(frame, point, truth) for a fifth of the odd frames' points: there are half a million.
   */
  template <typename F>
  void forEachAsked(const F& f) const {
    for (std::size_t i = 1; i < m_frames.size(); i += 2)
      for (std::size_t k = 0; k < m_frames[i].cloud.size(); k += 5)
        if (m_frames[i].cloud.classes[k] != kNoClass && !m_frames[i].isMoving(k))
          f(m_frames[i], k, m_frames[i].cloud.classes[k]);
  }

  Evaluation evaluate(double neighborWeight = 0) const { return evaluate(map, neighborWeight); }
  Evaluation evaluate(const SemanticOcTree& asked, double neighborWeight = 0) const {
    const semantic_octree::SmoothedView view(asked, {neighborWeight});
    Evaluation evaluation(asked.numClasses());
    forEachAsked([&](const LabeledFrame& frame, std::size_t k, ClassId truth) {
      evaluation.ask(view, frame.T_map_sensor * frame.cloud.points[k].cast<double>(), truth);
    });
    return evaluation;
  }

  SemanticOcTree map;

 private:
  std::vector<LabeledFrame> m_frames;
};
