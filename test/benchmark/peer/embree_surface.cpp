// SPDX-License-Identifier: BSD-3-Clause
// Embree: its tree of floats, with the triangle in double.
#include "surface_peer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::bench {
namespace {

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b)
{
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// After Ericson: Real-Time Collision Detection, 2005, 5.1.5; written anew.
double squaredDistance(const Vector& p, const std::array<Vector, 3>& t)
{
  const Vector ab = minus(t[1], t[0]), ac = minus(t[2], t[0]), ap = minus(p, t[0]);
  const auto from = [&](double u, double v) {
    const Vector d = {ap[0] - u * ab[0] - v * ac[0], ap[1] - u * ab[1] - v * ac[1], ap[2] - u * ab[2] - v * ac[2]};
    return dot(d, d);
  };
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return from(0, 0);
  const Vector bp = minus(p, t[1]);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return from(1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(d1 / (d1 - d3), 0);
  const Vector cp = minus(p, t[2]);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return from(0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / (d4 - d3 + d5 - d6);
    return from(1 - w, w);
  }
  const double sum = va + vb + vc;
  return from(vb / sum, vc / sum);
}

class Embree final : public SurfacePeer {
public:
  Embree(const MeshVertices& vertices, const MeshTriangles& triangles) : SurfacePeer(vertices, triangles)
  {
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const places = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        places[3 * i + k] = static_cast<float>(vertices[i][k]);
        largest_ = std::max(largest_, std::abs(vertices[i][k]));
      }
    auto* const corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i)
      std::copy(triangles[i].begin(), triangles[i].end(), corners + 3 * i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Embree() override
  {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  bool flag(const double* xyz, std::size_t count, double d, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Search search{this, {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, d * d, true, false};
      ask(search, d);
      out[i] = search.found ? 1 : 0;
    }
    return true;
  }

  bool distances(const double* xyz, std::size_t count, double* out) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Search search{
          this, {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, std::numeric_limits<double>::infinity(), false, false};
      ask(search, std::numeric_limits<double>::infinity());
      out[i] = std::sqrt(search.squared);
    }
    return true;
  }

  bool inside(const double* xyz, std::size_t count, std::uint8_t* out) override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Crossings crossings;
      rtcInitIntersectContext(&crossings.context);
      crossings.context.filter = [](const RTCFilterFunctionNArguments* arguments) {
        ++reinterpret_cast<Crossings*>(arguments->context)->count;
        arguments->valid[0] = 0; // and on
      };
      RTCRay ray{};
      ray.org_x = static_cast<float>(xyz[3 * i]);
      ray.org_y = static_cast<float>(xyz[3 * i + 1]);
      ray.org_z = static_cast<float>(xyz[3 * i + 2]);
      ray.dir_x = 1.0f;
      ray.tfar = std::numeric_limits<float>::infinity();
      ray.mask = ~0u;
      rtcOccluded1(scene_, &crossings.context, &ray);
      out[i] = static_cast<std::uint8_t>(crossings.count & 1u);
    }
    return true;
  }

private:
  struct Search {
    const Embree* self;
    Vector at;
    double squared; ///< of the nearest so far, or that of the limit
    bool any, found;
  };
  struct Crossings {
    RTCIntersectContext context; // first: what the filter is given
    unsigned count = 0;
  };

  void ask(Search& search, double radius) const
  {
    RTCPointQuery query{};
    query.x = static_cast<float>(search.at[0]);
    query.y = static_cast<float>(search.at[1]);
    query.z = static_cast<float>(search.at[2]);
    query.radius = padded(radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, visit, &search);
  }

  /// The padding covers the rounding of places to floats.
  float padded(double radius) const { return static_cast<float>(radius * (1 + 1e-6) + 1e-6 * largest_); }

  static bool visit(RTCPointQueryFunctionArguments* arguments)
  {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    const double squared = squaredDistance(search.at, search.self->triangle(arguments->primID));
    if (search.any) {
      if (squared > search.squared || search.found) return false;
      search.found = true;
      arguments->query->radius = 0.0f;
      return true;
    }
    if (squared >= search.squared) return false;
    search.squared = squared;
    arguments->query->radius = search.self->padded(std::sqrt(squared));
    return true;
  }

  RTCDevice device_;
  RTCScene scene_;
  double largest_ = 0.0;
};

} // namespace

std::unique_ptr<SurfacePeer> makeEmbree(const MeshVertices& vertices, const MeshTriangles& triangles)
{
  return std::make_unique<Embree>(vertices, triangles);
}

} // namespace pcl_bsh::bench
