// SPDX-License-Identifier: BSD-3-Clause
// Objects of PROJ's that are freed, for the sources that see PROJ.
#pragma once

#include <proj.h>

#include <memory>
#include <optional>
#include <string>

namespace pcl_bsh::io {

struct FreeProj {
  void operator()(PJ* object) const noexcept { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const noexcept { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const noexcept
  {
    proj_operation_factory_context_destroy(factory);
  }
  void operator()(PJ_CONTEXT* context) const noexcept { proj_context_destroy(context); }
};
using ProjObject = std::unique_ptr<PJ, FreeProj>;
using ProjList = std::unique_ptr<PJ_OBJ_LIST, FreeProj>;

/// PROJ's state, which fetches nothing and prints nothing.
class ProjContext {
public:
  ProjContext() : context_(proj_context_create())
  {
    proj_context_set_enable_network(get(), 0);
    proj_log_func(get(), &said_,
                  [](void* said, int, const char* message) { *static_cast<std::string*>(said) = message; });
  }
  ProjContext(const ProjContext&) = delete; // PROJ writes to its said_
  ProjContext& operator=(const ProjContext&) = delete;

  PJ_CONTEXT* get() const noexcept { return context_.get(); }
  const std::string& said() const noexcept { return said_; } ///< its last message

  /// The system of codes or WKT, or null. Other texts give null, because PROJ would take them for the name of a system
  /// with a similar name.
  ProjObject system(const std::string& definition) const
  {
    if (definition.find_first_of(":[{=") == std::string::npos) return nullptr;
    ProjObject system(proj_create(get(), definition.c_str()));
    if (system && !proj_is_crs(system.get())) system.reset();
    return system;
  }

  /// The system of places; of a system with heights, the part without them.
  ProjObject places(const PJ* system) const { return part(system, 0); }

  /// The system of heights, or null.
  ProjObject heights(const PJ* system) const { return part(system, 1); }

  /// The system without the transformation to WGS 84 that old WKT may have.
  ProjObject plain(const PJ* system) const
  {
    if (proj_get_type(system) == PJ_TYPE_BOUND_CRS) return ProjObject(proj_get_source_crs(get(), system));
    return ProjObject(proj_clone(get(), system));
  }

  /// The unit of a system's first axis, in metres or radians.
  double unitOf(const PJ* system) const
  {
    const ProjObject axes(proj_crs_get_coordinate_system(get(), plain(system).get()));
    double factor = 0.0;
    if (axes)
      proj_cs_get_axis_info(get(), axes.get(), 0, nullptr, nullptr, nullptr, &factor, nullptr, nullptr, nullptr);
    return factor;
  }

private:
  ProjObject part(const PJ* system, int index) const
  {
    const ProjObject whole = plain(system);
    if (proj_get_type(whole.get()) == PJ_TYPE_COMPOUND_CRS)
      return ProjObject(proj_crs_get_sub_crs(get(), whole.get(), index));
    return index == 0 ? ProjObject(proj_clone(get(), system)) : nullptr;
  }

  std::string said_;
  std::unique_ptr<PJ_CONTEXT, FreeProj> context_;
};

} // namespace pcl_bsh::io
