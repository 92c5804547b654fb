// SPDX-License-Identifier: BSD-3-Clause
#include "closest_pair_actor.h"

#include "caption.h"
#include "text.h"

#include <vtkBillboardTextActor3D.h>
#include <vtkLineSource.h>
#include <vtkNew.h>
#include <vtkProperty.h>
#include <vtkTextProperty.h>

namespace pcl_bsh::viewer {

void addClosestPair(PropGroup& group, const ClosestPair& closest, const std::string& unit)
{
  vtkNew<vtkLineSource> line;
  line->SetPoint1(closest.a.data());
  line->SetPoint2(closest.b.data());
  line->Update();
  const auto segment = actorOf(line->GetOutput());
  setColor(*segment, segment_color);
  segment->GetProperty()->SetLineWidth(3.0f);
  group.add(segment);
  vtkNew<vtkBillboardTextActor3D> label;
  const Eigen::Vector3d middle = (closest.a + closest.b) / 2;
  label->SetPosition(middle.x(), middle.y(), middle.z());
  label->SetDisplayOffset(8, 8);
  label->SetInput(lengthOf(closest.distance, unit).c_str());
  const std::array<double, 3> c = fractions(segment_color);
  label->GetTextProperty()->SetColor(c[0], c[1], c[2]);
  label->GetTextProperty()->SetFontSize(text_size);
  group.add(label.Get());
}

} // namespace pcl_bsh::viewer
