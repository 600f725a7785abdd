#pragma once
#include <vector>

#include "LabeledFrame.h"

/** The LiDAR scans of the shipped sample at their true poses. */
std::vector<LabeledFrame> readSampleScans();
