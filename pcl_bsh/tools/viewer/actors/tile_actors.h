// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"
#include "value_bar.h"
#include "value_histogram.h"
#include <pcl_bsh/tools/viewer/content/site_content.h>
#include <pcl_bsh/tools/viewer/content/tile_choice.h>

#include <vtkPicker.h>
#include <vtkRenderer.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::viewer {

/// The tiles of a site that the camera sees nearest, as clouds coloured like its overview.
class TileActors {
public:
  /// @param overview drawn and painted already
  TileActors(const SiteContent& site, vtkRenderer& renderer, const CloudActor& overview, ValueBar& bar,
             ValueHistogram& histogram, Coloring coloring);

  /// Drops tiles that the camera does not want any more, and loads the nearest tile that it wants.
  /// @return whether anything changed
  /// @throws files::FileError for a tile that cannot be read: it is not asked for again
  bool step();

  void setMoving(bool moving); ///< none is drawn while the picture moves
  void offerTo(vtkPicker& points, vtkPicker& triangles) const;

  /// A tile and a point of it.
  struct Part {
    const ViewContent* content;
    std::uint32_t record;
  };
  std::optional<Part> partOf(const vtkProp* prop, vtkIdType id) const;

  std::string text() const; ///< how many are drawn, of how many

private:
  struct Shown {
    std::unique_ptr<ViewContent> content;
    std::unique_ptr<CloudActor> actor;
  };

  Eye eye() const;
  void load(std::size_t tile);

  const SiteContent& site_;
  vtkRenderer& renderer_;
  ValueBar& bar_;
  ValueHistogram& histogram_;
  Coloring coloring_;
  SharedColors alike_;
  TileChoice choice_;
  std::map<std::size_t, Shown> shown_;
};

} // namespace pcl_bsh::viewer
