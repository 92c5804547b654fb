// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/picture.h>

#include <librsvg/rsvg.h>

#include <memory>
#include <stdexcept>

namespace pcl_bsh::io {
namespace {

template <auto release>
struct Release {
  template <typename T>
  void operator()(T* held) const
  {
    release(held);
  }
};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size)
{
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

} // namespace

bool drawsPictures()
{
  return true;
}

std::string pngOf(const std::string& svg, double pixels)
{
  GError* error = nullptr;
  const auto check = [&](bool done) {
    if (done) return;
    const std::unique_ptr<GError, Release<g_error_free>> held(error);
    throw std::runtime_error(std::string("librsvg cannot draw a picture: ") + (held ? held->message : "out of memory"));
  };
  const std::unique_ptr<RsvgHandle, Release<g_object_unref>> drawing(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  check(drawing != nullptr);
  gboolean has_width, has_height, has_box;
  RsvgLength width, height;
  RsvgRectangle box;
  rsvg_handle_get_intrinsic_dimensions(drawing.get(), &has_width, &width, &has_height, &height, &has_box, &box);
  const RsvgRectangle page{0.0, 0.0, pixels * box.width, pixels * box.height};
  const std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(page.width), static_cast<int>(page.height)));
  const std::unique_ptr<cairo_t, Release<cairo_destroy>> pen(cairo_create(surface.get()));
  check(rsvg_handle_render_document(drawing.get(), pen.get(), &page, &error));
  std::string png;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &png) == CAIRO_STATUS_SUCCESS);
  return png;
}

} // namespace pcl_bsh::io
