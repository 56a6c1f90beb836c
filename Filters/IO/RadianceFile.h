#pragma once

#include <string>
#include <vector>

/// Reads pictures of radiance that may be truncated or corrupt.
namespace tyndall
{
/// A picture, rows from the bottom up.
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

/// Radiance's RGBE and XYZE pictures (.hdr, .pic): every order of axes, flat, old and new run lengths; EXPOSURE lines
/// are divided out, XYZE becomes linear sRGB. (vtkHDRReader trusts the file: a run may be longer than the row it is
/// written to, a size that does not parse is used as it is, and a short file leaves its last rows unset.)
/// @throws InvalidInput naming the file, what is wrong and where
PictureSize SizeOfHdr(const std::string& path);
RadiancePicture ReadHdr(const std::string& path);

/// OpenEXR (.exr), half, float or integer: R G B at the root or in the first layer that has them; or Y alone (grey); or
/// Y, RY, BY. Scan lines or tiles (their finest level), the first part of several. The picture is the display window;
/// where the data window does not reach it is black.
/// @throws InvalidInput naming the file, what is wrong and where
PictureSize SizeOfExr(const std::string& path);
RadiancePicture ReadExr(const std::string& path);
}
