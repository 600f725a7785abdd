#pragma once
#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt_compat/Release.h>
#include <semantic_octree/SemanticOcTree.h>

#include <filesystem>
#include <optional>
#include <string>

#include "RunProgram.h"
#include "TemporaryFolder.h"

/** MRPT's applications as Debian ships them, in a folder of their own, where `config` and
 * `rawlog-samples` are those of the sources: commands are written as in
 * doc/handbook/stock-applications.md. */
class StockApps : public testing::Test {
 protected:
  enum class Plugin { Absent, Preloaded };

  StockApps();

  /** Runs a shell command in the folder, without a terminal, for some minutes at most. */
  ProgramRun run(const std::string& command, Plugin plugin = Plugin::Absent) const;
  /** The semantic octree that an application left below a folder; none if there is none. */
  std::optional<semantic_octree::SemanticOcTree> mapIn(const std::string& subfolder) const;
  /** The first PAIRS of actions and observations of one of mrpt-common's rawlogs.
   * (rawlog-edit --cut leaves a last pair without observations, at which icp-slam gives up.) */
  std::string shortRawlog(const std::string& dataset, std::size_t pairs) const;

  static const std::string kPlugin;
  TemporaryFolder folder;
};

/** Whether MRPT ends with an error at a map that it does not know, instead of leaving it out. */
constexpr bool kMrptRefusesUnknownMaps = MSO_MRPT_AT_LEAST(2, 11, 3);

/** Whether rawlog-edit drops what it is told to drop: with an error of MRPT it keeps everything. */
constexpr bool kRawlogEditDrops = !MSO_MRPT_AT_LEAST(2, 12, 1) || MSO_MRPT_AT_LEAST(3, 0, 3);

/** The laser scanner's round through a corridor that mrpt-common ships. */
inline const char* const kLaserRawlog = "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";

/** Skips the running test, saying so, where one of MRPT's programs is absent, or cannot load what
 * is built upon this MRPT. */
#define SKIP_WITHOUT_APP(NAME)                                                               \
  if (MSO_MRPT_AT_LEAST(3, 0, 0)) GTEST_SKIP() << "Debian's programs are built with MRPT 2"; \
  SKIP_WITHOUT("/usr/bin/" NAME, "mrpt-apps")

/** Skips the running test, saying so, where a program or file of a Debian package is absent. */
#define SKIP_WITHOUT(PATH, PACKAGE) \
  if (!std::filesystem::exists(PATH)) GTEST_SKIP() << "needs " << (PATH) << " (package " PACKAGE ")"

/** A semantic octree of a laser scanner, a points map of the same scans (as MRPT saves it, a line
 * "x y z" a point), and the robot's path ("step x y phi" or more). */
struct LaserMapCheck {
  double pointsInOccupied = 0;  ///< share of the points that lie in an occupied voxel or beside one
  double occupiedAtPoints = 0;  ///< share of occupied voxels with such a point
  double pathInFree = 0;        ///< share of the scanner's places that are free
};

LaserMapCheck checkLaserMap(const semantic_octree::SemanticOcTree& map,
                            const std::filesystem::path& points, const std::filesystem::path& path);

/** The first frames of rawlog-samples/village.rawlog with their true poses: in each a labeled depth
 * image and a labeled LiDAR scan. */
mrpt::maps::CSimpleMap villageFrames(std::size_t count);
