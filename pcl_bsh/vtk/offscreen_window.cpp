// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/vtk/display.h>
#include <pcl_bsh/vtk/offscreen_window.h>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPNGWriter.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <stdexcept>
#include <string_view>

namespace pcl_bsh::vtk {
namespace {

/// The program's only OpenGL context without a display; made once, kept to the end.
class EglContext {
public:
  static void makeCurrent()
  {
    static const EglContext context;
    if (!eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_))
      throw std::runtime_error("drawing without a display: EGL's context cannot be made current: set DISPLAY");
  }

private:
  EglContext()
  {
    const auto platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    display_ = platform_display ? platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                                : EGL_NO_DISPLAY;
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
      throw std::runtime_error("drawing without a display: EGL cannot be had: install libegl-mesa0, or set DISPLAY");
    constexpr EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    constexpr EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display_, wanted, &config, 1, &count);
    context_ = eglCreateContext(display_, count > 0 ? config : nullptr, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT)
      throw std::runtime_error("drawing without a display: EGL gives no OpenGL 3.3: install libgl1-mesa-dri");
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// VTK asks its generic window whether the context is current; it is.
void answerThatItIsCurrent(vtkObject*, unsigned long, void*, void* answer)
{
  EglContext::makeCurrent();
  *static_cast<bool*>(answer) = true;
}

void makeCurrent(vtkObject*, unsigned long, void*, void*)
{
  EglContext::makeCurrent();
}

/// GLEW does not find a GLX display, which VTK reports as an error although drawing works: that message is dropped.
/// Other errors go where VTK's go.
void passOnErrors(vtkObject*, unsigned long, void*, void* text)
{
  const char* const error = static_cast<const char*>(text);
  if (std::string_view(error).find("GLEW could not be initialized") == std::string_view::npos)
    vtkOutputWindow::GetInstance()->DisplayErrorText(error);
}

vtkSmartPointer<vtkRenderWindow> makeEglWindow()
{
  EglContext::makeCurrent();
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->SetOwnContext(0);
  window->SetSupportsOpenGL(1);
  window->SetIsDirect(1);
  window->SetReadyForRendering(true);
  window->SetMapped(1);
  vtkNew<vtkCallbackCommand> is_current, make_current, error;
  is_current->SetCallback(answerThatItIsCurrent);
  make_current->SetCallback(makeCurrent);
  error->SetCallback(passOnErrors);
  window->AddObserver(vtkCommand::ErrorEvent, error);
  window->AddObserver(vtkCommand::WindowIsCurrentEvent, is_current);
  window->AddObserver(vtkCommand::WindowMakeCurrentEvent, make_current);
  return window;
}

} // namespace

vtkSmartPointer<vtkRenderWindow> makeOffscreenWindow(int width, int height)
{
  vtkSmartPointer<vtkRenderWindow> window = haveDisplay() ? vtkSmartPointer<vtkRenderWindow>::New() : makeEglWindow();
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0); // pictures must not depend on the driver
  window->SetSize(width, height);
  return window;
}

void writePng(vtkRenderWindow& window, const std::filesystem::path& path)
{
  vtkNew<vtkWindowToImageFilter> image;
  window.Render();
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  image->Update();
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  const vtkUnsignedCharArray* const bytes = writer->GetResult();

  const auto* const begin = reinterpret_cast<const char*>(const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0));
  files::replaceFile(path, [&](std::ostream& out) { out.write(begin, bytes->GetNumberOfValues()); });
}

} // namespace pcl_bsh::vtk
