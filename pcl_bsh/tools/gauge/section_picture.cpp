// SPDX-License-Identifier: BSD-3-Clause
#include "section_picture.h"

#include <pcl_bsh/tools/cli/program.h>

#ifdef PCL_BSH_RSVG
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <librsvg/rsvg.h>

#include <memory>
#include <ostream>
#endif

namespace pcl_bsh::cli {

#ifdef PCL_BSH_RSVG

namespace {

constexpr double pixels_of_unit = 3.0; ///< letters of 11 units are read without a lens

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

void requirePictures()
{
}

void writePicture(const std::filesystem::path& path, const std::string& svg)
{
  GError* error = nullptr;
  const auto check = [&](bool done) {
    if (done) return;
    const std::unique_ptr<GError, Release<g_error_free>> held(error);
    throw files::FileError(path, std::string("cannot be drawn: ") + (held ? held->message : "out of memory"),
                           "leave out --png");
  };
  const std::unique_ptr<RsvgHandle, Release<g_object_unref>> drawing(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  check(drawing != nullptr);
  gboolean has_width, has_height, has_box;
  RsvgLength width, height;
  RsvgRectangle box;
  rsvg_handle_get_intrinsic_dimensions(drawing.get(), &has_width, &width, &has_height, &height, &has_box, &box);
  const RsvgRectangle page{0.0, 0.0, pixels_of_unit * box.width, pixels_of_unit * box.height};
  const std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(page.width), static_cast<int>(page.height)));
  const std::unique_ptr<cairo_t, Release<cairo_destroy>> pen(cairo_create(surface.get()));
  check(rsvg_handle_render_document(drawing.get(), pen.get(), &page, &error));
  std::string png;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &png) == CAIRO_STATUS_SUCCESS);
  files::replaceFile(path, [&](std::ostream& out) { out << png; });
}

#else

void requirePictures()
{
  throw UsageError(
      "--png: this program was built without librsvg: build it where librsvg2-dev is installed, or leave it "
      "out: browsers show the .svg files");
}

void writePicture(const std::filesystem::path&, const std::string&)
{
  requirePictures();
}

#endif

} // namespace pcl_bsh::cli
