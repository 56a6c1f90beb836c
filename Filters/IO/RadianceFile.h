#pragma once

#include <string>
#include <vector>

/// Reads pictures of radiance that may be truncated or corrupt.
namespace tyndall
{
/// A picture, rows from bottom to top.
struct RadiancePicture
{
  int Width = 0;
  int Height = 0;
  std::vector<float> Rgb; ///< 3 * Width * Height
};

struct PictureSize
{
  int Width, Height;
};

/// Radiance pictures, RGBE and XYZE (.hdr, .pic): all orders of axes; flat, old and new run-length encodings. Values
/// are divided by the product of the EXPOSURE lines, XYZE is converted to linear sRGB. vtkHDRReader of VTK 9.2 takes
/// the last EXPOSURE only, and reads columns (+X first), old runs and truncated files as noise: TestEnvironmentReader.
/// @throws InvalidInput naming the file, the error and its position
PictureSize SizeOfHdr(const std::string& path);
RadiancePicture ReadHdr(const std::string& path);

/// OpenEXR pictures (.exr) of half, float or integer: R G B at the root or in the first layer that has them; or Y alone
/// (grey); or Y, RY, BY. Scan lines or tiles (finest level); the first of several parts. The picture is the display
/// window, black outside of the data window.
/// @throws InvalidInput naming the file, the error and its position
PictureSize SizeOfExr(const std::string& path);
RadiancePicture ReadExr(const std::string& path);
}
