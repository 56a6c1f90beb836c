#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

class vtkRenderer;
class vtkWindow;

namespace tyndall
{
/// Size of a renderer's viewport, columns and rows of pixels.
std::array<int, 2> DrawnSize(vtkRenderer* renderer);

/// The renderer's depth buffer, in [0, 1], row by row from below; 1 where nothing has been drawn.
std::vector<float> DrawnDepths(vtkRenderer* renderer);

/// Blends pictures over what a renderer has drawn.
class PictureOverlay
{
public:
  /// Which part of the viewport to draw over, tested per sample if multisampling is on.
  enum class Over
  {
    All,
    Background, ///< where nothing has been drawn
    Objects,    ///< where something has been drawn
  };

  PictureOverlay();
  ~PictureOverlay();

  /// @param pixels  red, green, blue, premultiplied by alpha, and alpha, row by row from below
  /// @param size    columns and rows of the picture, which is stretched to the renderer's viewport
  void Draw(vtkRenderer* renderer, const std::vector<std::uint8_t>& pixels, const std::array<int, 2>& size,
    Over over = Over::All);

  /// Frees graphics resources: to be called before the window is deleted or another one is drawn in.
  void Release(vtkWindow* window);

private:
  struct Resources;
  std::unique_ptr<Resources> Made;
};
}
