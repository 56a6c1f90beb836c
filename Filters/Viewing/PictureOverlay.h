#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

class vtkRenderer;
class vtkWindow;

namespace tyndall
{
/// Size of a renderer's viewport (of its current tile), columns and rows of pixels.
std::array<int, 2> DrawnSize(vtkRenderer* renderer);

/// Depth buffer of a renderer's viewport, values in [0, 1], rows from bottom to top; 1 where nothing has been drawn.
std::vector<float> DrawnDepths(vtkRenderer* renderer);

/// Blends pictures over the image that a renderer has drawn, by OpenGL.
class PictureOverlay
{
public:
  /// Part of the viewport over which a picture is blended, tested per sample if multisampling is on.
  enum class Over
  {
    All,
    Background, ///< only where the renderer has drawn nothing
    Objects,    ///< only where the renderer has drawn an object
  };

  PictureOverlay();
  ~PictureOverlay();

  /// Blends a picture over the viewport.
  /// @param pixels  red, green, blue, premultiplied by alpha, and alpha of each pixel, rows from bottom to top
  /// @param size    columns and rows of the picture, which is scaled to the renderer's viewport
  void Draw(vtkRenderer* renderer, const std::vector<std::uint8_t>& pixels, const std::array<int, 2>& size,
    Over over = Over::All);

  /// Frees the graphics resources. To be called before the window is deleted, or before drawing in another window.
  void Release(vtkWindow* window);

private:
  struct Resources;
  std::unique_ptr<Resources> Made;
};
}
