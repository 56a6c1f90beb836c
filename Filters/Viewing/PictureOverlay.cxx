#include "PictureOverlay.h"

#include "vtkNew.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"

namespace tyndall
{
namespace
{
// Constants that OpenGL's headers define; VTK's headers do not include those.
constexpr unsigned int GlOne = 1;
constexpr unsigned int GlOneMinusSourceAlpha = 0x0303;
constexpr unsigned int GlBlend = 0x0BE2;
constexpr unsigned int GlDepthTest = 0x0B71;
constexpr unsigned int GlLessOrEqual = 0x0203;
constexpr unsigned int GlGreater = 0x0204;

const char* const FragmentShader = R"(//VTK::System::Dec
in vec2 texCoord;
uniform sampler2D picture;
//VTK::Output::Dec
void main()
{
  gl_FragData[0] = texture2D(picture, texCoord);
  gl_FragDepth = 1.0; // behind all that is drawn
}
)";

vtkOpenGLRenderWindow* WindowOf(vtkRenderer* renderer)
{
  return vtkOpenGLRenderWindow::SafeDownCast(renderer->GetVTKWindow());
}
}

std::array<int, 2> DrawnSize(vtkRenderer* renderer)
{
  std::array<int, 2> size, corner;
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &corner[0], &corner[1]);
  return size;
}

std::vector<float> DrawnDepths(vtkRenderer* renderer)
{
  std::array<int, 2> size, corner;
  renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &corner[0], &corner[1]);
  std::vector<float> depths(static_cast<std::size_t>(size[0]) * size[1]);
  WindowOf(renderer)->GetZbufferData(
    corner[0], corner[1], corner[0] + size[0] - 1, corner[1] + size[1] - 1, depths.data());
  return depths;
}

struct PictureOverlay::Resources
{
  vtkNew<vtkTextureObject> texture;
  std::unique_ptr<vtkOpenGLQuadHelper> quad;
};

PictureOverlay::PictureOverlay() = default;
PictureOverlay::~PictureOverlay() = default;

void PictureOverlay::Draw(
  vtkRenderer* renderer, const std::vector<std::uint8_t>& pixels, const std::array<int, 2>& size, Over over)
{
  vtkOpenGLRenderWindow* const window = WindowOf(renderer);
  if (!this->Made)
  {
    this->Made = std::make_unique<Resources>();
    this->Made->texture->SetContext(window);
    this->Made->quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr, FragmentShader, "");
  }
  vtkTextureObject* const texture = this->Made->texture;
  vtkOpenGLQuadHelper& quad = *this->Made->quad;
  const bool asItIs = size == DrawnSize(renderer);
  texture->SetMinificationFilter(asItIs ? vtkTextureObject::Nearest : vtkTextureObject::Linear);
  texture->SetMagnificationFilter(asItIs ? vtkTextureObject::Nearest : vtkTextureObject::Linear);
  texture->SetWrapS(vtkTextureObject::ClampToEdge);
  texture->SetWrapT(vtkTextureObject::ClampToEdge);
  texture->Create2DFromRaw(size[0], size[1], 4, VTK_UNSIGNED_CHAR, const_cast<std::uint8_t*>(pixels.data()));

  vtkOpenGLState* const state = window->GetState();
  const vtkOpenGLState::ScopedglEnableDisable depthTest(state, GlDepthTest);
  const vtkOpenGLState::ScopedglEnableDisable blend(state, GlBlend);
  const vtkOpenGLState::ScopedglDepthMask depthMask(state);
  const vtkOpenGLState::ScopedglBlendFuncSeparate function(state);
  if (over == Over::All)
  {
    state->vtkglDisable(GlDepthTest);
  }
  else // blends where the depth test passes, per sample: an object's edge may cover some samples of a pixel
  {
    state->vtkglEnable(GlDepthTest);
    state->vtkglDepthFunc(over == Over::Background ? GlLessOrEqual : GlGreater);
  }
  state->vtkglDepthMask(0);
  state->vtkglEnable(GlBlend);
  state->vtkglBlendFuncSeparate(GlOne, GlOneMinusSourceAlpha, GlOne, GlOneMinusSourceAlpha);
  window->GetShaderCache()->ReadyShaderProgram(quad.Program);
  texture->Activate();
  quad.Program->SetUniformi("picture", texture->GetTextureUnit());
  quad.Render();
  texture->Deactivate();
  state->vtkglDepthFunc(GlLessOrEqual); // VTK's default depth function
}

void PictureOverlay::Release(vtkWindow* window)
{
  if (this->Made)
  {
    this->Made->texture->ReleaseGraphicsResources(window);
    this->Made->quad->ReleaseGraphicsResources(window);
    this->Made.reset();
  }
}
}
