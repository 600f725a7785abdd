#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt_compat/Release.h>
#if MSO_MRPT_AT_LEAST(2, 11, 3)
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/maps/NearestNeighborsCapable.h>
#endif

#include <cstdint>
#include <string>
#include <vector>

namespace mrpt::maps {
class CPointsMap;
}

/** CMetricMap has no boundingBox() before. */
#if MSO_MRPT_AT_LEAST(2, 11, 3)
#define MSO_OVERRIDE_SINCE_2_11_3 override
#else
#define MSO_OVERRIDE_SINCE_2_11_3
#endif

namespace mrpt_compat {

/** What a cloud's points have under a name: one number for each point, or none. Colors between 0
 * and 1 are "color_rf", "color_gf", "color_bf". Times, in seconds after the observation's, are "t"
 * (MRPT 2.14). CGenericPointsMap has what its user registered (MRPT 2.15). */
std::vector<double> pointField(const mrpt::maps::CPointsMap& cloud, const std::string& name);

#if MSO_MRPT_AT_LEAST(2, 11, 3)
/** What a map's factory function returns. */
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;
#endif

#if MSO_MRPT_AT_LEAST(2, 11, 3)
/** Base of a map that has points (getAsSimplePointsMap()): who asks for nearest neighbors, as the
 * matchers of mp2p_icp do, is told those among them. Indices are those of the points. */
template <class Map>
class NearestByPoints : public mrpt::maps::NearestNeighborsCapable {
  using Point2 = mrpt::math::TPoint2Df;
  using Point3 = mrpt::math::TPoint3Df;
  using Index = std::uint64_t;

 public:
  bool nn_has_indices_or_ids() const override { return true; }
  void nn_prepare_for_2d_queries() const override { points().nn_prepare_for_2d_queries(); }
  void nn_prepare_for_3d_queries() const override { points().nn_prepare_for_3d_queries(); }
  std::size_t nn_index_count() const override { return points().size(); }
  bool nn_single_search(const Point3& query, Point3& result, float& squared,
                        Index& index) const override {
    return !points().empty() && points().nn_single_search(query, result, squared, index);
  }
  bool nn_single_search(const Point2& query, Point2& result, float& squared,
                        Index& index) const override {
    return !points().empty() && points().nn_single_search(query, result, squared, index);
  }
  void nn_multiple_search(const Point3& query, std::size_t count, std::vector<Point3>& results,
                          std::vector<float>& squared, std::vector<Index>& indices) const override {
    results.clear(), squared.clear(), indices.clear();
    if (!points().empty()) points().nn_multiple_search(query, count, results, squared, indices);
  }
  void nn_multiple_search(const Point2& query, std::size_t count, std::vector<Point2>& results,
                          std::vector<float>& squared, std::vector<Index>& indices) const override {
    results.clear(), squared.clear(), indices.clear();
    if (!points().empty()) points().nn_multiple_search(query, count, results, squared, indices);
  }
  void nn_radius_search(const Point3& query, float squaredRadius, std::vector<Point3>& results,
                        std::vector<float>& squared, std::vector<Index>& indices,
                        std::size_t most) const override {
    results.clear(), squared.clear(), indices.clear();
    if (!points().empty())
      points().nn_radius_search(query, squaredRadius, results, squared, indices, most);
  }
  void nn_radius_search(const Point2& query, float squaredRadius, std::vector<Point2>& results,
                        std::vector<float>& squared, std::vector<Index>& indices,
                        std::size_t most) const override {
    results.clear(), squared.clear(), indices.clear();
    if (!points().empty())
      points().nn_radius_search(query, squaredRadius, results, squared, indices, most);
  }

 private:
  const mrpt::maps::CSimplePointsMap& points() const {
    return *static_cast<const Map&>(*this).getAsSimplePointsMap();
  }
};
#else
/** MRPT does not ask maps for nearest neighbors before. */
template <class Map>
class NearestByPoints {};
#endif

}  // namespace mrpt_compat
