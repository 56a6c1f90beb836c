#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

class vtkRenderer;
class vtkWindow;

namespace tyndall
{
/// Columns and rows of what a renderer is drawing, pixels.
std::array<int, 2> DrawnSize(vtkRenderer* renderer);

/// Depths of what it has drawn so far, in [0, 1], row by row from below; 1 where there is nothing.
std::vector<float> DrawnDepths(vtkRenderer* renderer);

/// Lays pictures over what a renderer has drawn.
class PictureOverlay
{
public:
  /// What of the screen, sample by sample where a pixel has several.
  enum class Over
  {
    All,
    Background, ///< where nothing is drawn
    Objects,    ///< where something is
  };

  PictureOverlay();
  ~PictureOverlay();

  /// @param pixels  red, green, blue, which are multiplied by alpha already, and alpha, row by row from below
  /// @param size    columns and rows; stretched to all that the renderer draws
  void Draw(vtkRenderer* renderer, const std::vector<std::uint8_t>& pixels, const std::array<int, 2>& size,
    Over over = Over::All);

  /// Before the window goes, or another one is drawn in.
  void Release(vtkWindow* window);

private:
  struct Resources;
  std::unique_ptr<Resources> Made;
};
}
