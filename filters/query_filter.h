// SPDX-License-Identifier: BSD-3-Clause
// PCL's conventions of a filter, around a query that tells which points to keep. Use CollisionFilter or DistanceFilter.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/input_filter.h>
#include <pcl_bsh/filters/question_filter.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>

#include <type_traits>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// PCL's filter() is not virtual. Called through a pointer to pcl::Filter, it leaves the output alone when the input is
/// missing. It does so, too, from PCL 1.15 on, when memory runs out while PCL numbers the points of the input, and
/// prints a line. PCL does that only where the input has grown since setInputCloud(), where the last setIndices() was
/// given null, or where the input, a pcl::PCLPointCloud2, was set through that pointer. In all other cases
/// std::bad_alloc comes out.
/// @tparam Settings a QuestionFilter with passing()
template <typename PointT, typename Settings>
class QueryFilter : public InputFilter<PointT>, public Settings {
public:
  using Cloud =
      std::conditional_t<std::is_same_v<PointT, pcl::PCLPointCloud2>, pcl::PCLPointCloud2, pcl::PointCloud<PointT>>;

  /// A copy has all settings, and what it finds is its own: copies may filter at the same time. They share the
  /// obstacle's hierarchy, which is built once. Where memory runs out, a filter that is assigned to stays as it was.
  QueryFilter(const QueryFilter& other);
  QueryFilter& operator=(const QueryFilter& other);
  ~QueryFilter() override = default;

  /// Keeps the points that the query says; after setNegative(true), the others. Points that are not finite are removed
  /// either way. `output` may be the input; on an error it stays as it was, and getRemovedIndices() is of this call or
  /// the one before.
  /// @throws std::invalid_argument when input or obstacle is missing, or a setting is not what its declaration asks for
  /// @throws std::bad_alloc when memory runs out
  void filter(Cloud& output);

  /// Filters to indices into the input, in its order.
  void filter(pcl::Indices& indices);

protected:
  /// @param extract_removed_indices keep what getRemovedIndices() returns
  /// @param name as PCL's messages say it
  QueryFilter(bool extract_removed_indices, const char* name);

  using pcl::FilterIndices<PointT>::applyFilter;
  void applyFilter(pcl::Indices& indices) override;

  /// The points that are asked about. @throws std::invalid_argument when there are none
  Shape inputShape() const { return this->inputOf(inputView(), *this->input_); }
  PointsView inputView() const;

  /// Divides the input's records into kept and removed ones, by the answer of passing().
  void select(const std::vector<std::uint8_t>& passes, pcl::Indices& kept, pcl::Indices* removed) const
  {
    partRecords(inputView(), passes, this->negative_, kept, removed);
  }

  /// Where `set` throws, the indices stay as they were.
  template <typename Set>
  void keepingIndices(const Set& set)
  {
    const pcl::IndicesPtr former = this->indices_;
    try {
      set();
    }
    catch (...) {
      this->indices_ = former;
      throw;
    }
  }

private:
  pcl::IndicesPtr removedOfItsOwn() const;
  pcl::IndicesPtr indicesOfItsOwn() const;

public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END
