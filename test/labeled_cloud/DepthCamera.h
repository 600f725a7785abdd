#pragma once
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>
#include <functional>

/** Depth camera of the tests: f = 50 pixels, principal point off the middle, millimeters. */
struct DepthCamera {
  int rows = 40, cols = 60;
  double f = 50, cx = 28.5, cy = 21.25;

  /** An observation in whose pixel (row, col) the depth is DEPTH(row, col), in meters. */
  mrpt::obs::CObservation3DRangeScan::Ptr see(const std::function<double(int, int)>& depth) const {
    auto scan = mrpt::obs::CObservation3DRangeScan::Create();
    scan->sensorLabel = "cam";
    scan->timestamp = mrpt::Clock::fromDouble(10);
    scan->cameraParams.ncols = cols;
    scan->cameraParams.nrows = rows;
    scan->cameraParams.setIntrinsicParamsFromValues(f, f, cx, cy);
    scan->hasRangeImage = true;
    scan->rangeImage_setSize(rows, cols);
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < cols; ++c)
        scan->rangeImage(r, c) = static_cast<std::uint16_t>(1000 * depth(r, c) + 0.5);
    return scan;
  }

  /** Labels of the pixels as MRPT keeps them; a negative label is none. */
  template <unsigned BYTES = 8>
  void label(mrpt::obs::CObservation3DRangeScan& scan,
             const std::function<int(int, int)>& labelOf) const {
    auto labels = std::make_shared<mrpt::obs::TPixelLabelInfo<BYTES>>();
    labels->setSize(rows, cols);
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < cols; ++c)
        if (const int label = labelOf(r, c); label >= 0) labels->setLabel(r, c, label);
    scan.pixelLabels = labels;
  }
};
