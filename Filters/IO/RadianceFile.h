#pragma once

#include <string>
#include <vector>

/// Reads pictures of radiance that may be truncated or corrupt.
namespace tyndall
{
/// A picture of radiance, rows from bottom to top.
struct RadiancePicture
{
  int Width = 0;
  int Height = 0;
  std::vector<float> Rgb; ///< red, green, blue of each pixel: 3 * Width * Height values
};

struct PictureSize
{
  int Width, Height;
};

/// Reads the size, or the pixels, of a Radiance picture in RGBE or XYZE (.hdr, .pic). All orders of axes, and flat, old
/// and new run-length encodings are supported. Values are divided by the product of the EXPOSURE lines; XYZE is
/// converted to linear sRGB. vtkHDRReader of VTK 9.2 uses the last EXPOSURE only, and returns noise for pictures stored
/// by columns (+X first), for old run-length encoding and for truncated files (see TestEnvironmentReader).
/// @throws InvalidInput naming the file, the error and its position
PictureSize SizeOfHdr(const std::string& path);
RadiancePicture ReadHdr(const std::string& path);

/// Reads the size, or the pixels, of an OpenEXR picture (.exr) of half, float or integer numbers. Channels: R G B at
/// the root or in the first layer that has them; or Y alone (grey); or Y, RY, BY. The picture may be stored in scan
/// lines or in tiles (the finest level is read); the first of several parts is read. The result is the display window,
/// black outside of the data window.
/// @throws InvalidInput naming the file, the error and its position
PictureSize SizeOfExr(const std::string& path);
RadiancePicture ReadExr(const std::string& path);
}
