#include "vtkEnvironmentReader.h"

#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"
#include "Common/PrintMembers.h"
#include "IO/Files.h"
#include "IO/RadianceFile.h"
#include "Pieces/GuardedWork.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <fstream>

using tyndall::InvalidInput;
using tyndall::PictureSize;
using tyndall::RadiancePicture;

namespace
{
enum class Kind
{
  Unknown,
  OpenExr,
  Radiance,
};

Kind KindOf(const std::string& path)
{
  if (!tyndall::HasAnEnd(path))
  {
    return Kind::Unknown;
  }
  std::ifstream stream(path, std::ios::binary);
  char start[4] = {};
  stream.read(start, 4);
  const std::string text(start, 4);
  return text == "\x76\x2f\x31\x01" ? Kind::OpenExr : text.compare(0, 2, "#?") == 0 ? Kind::Radiance : Kind::Unknown;
}

/// Type of a file according to its content. If the content is not recognised, the type is that of the extension, and
/// its reader reports the error.
Kind KindToRead(const char* path)
{
  tyndall::Require(path != nullptr && path[0] != '\0', "No file: set FileName.");
  const Kind kind = KindOf(path);
  const std::string text = path;
  const bool exr = text.size() > 4 && text.compare(text.size() - 4, 4, ".exr") == 0;
  return kind != Kind::Unknown ? kind : exr ? Kind::OpenExr : Kind::Radiance;
}

PictureSize Shrunk(const PictureSize& size, int width)
{
  if (width == 0 || width >= size.Width)
  {
    return size;
  }
  return { width, std::max(1, static_cast<int>(std::lround(double(size.Height) * width / size.Width))) };
}

/// Sets negative values of a picture to 0.
/// @throws InvalidInput if a pixel is not finite
/// @return number of values that were negative
std::size_t Clean(RadiancePicture& picture, const std::string& path)
{
  std::size_t negative = 0;
  for (std::size_t i = 0; i < picture.Rgb.size(); ++i)
  {
    float& value = picture.Rgb[i];
    if (!std::isfinite(value))
    {
      const std::size_t pixel = i / 3, width = static_cast<std::size_t>(picture.Width);
      throw InvalidInput("\"" + path + "\" is not finite at column " + std::to_string(pixel % width) + ", row " +
        std::to_string(static_cast<std::size_t>(picture.Height) - 1 - pixel / width) +
        " from the top. Repair the picture, or write it again with 32 bits.");
    }
    if (value < 0.0f)
    {
      value = 0.0f;
      ++negative;
    }
  }
  return negative;
}

/// Applies the properties Exposure and MaximumRadiance to a picture.
void Expose(RadiancePicture& picture, double exposure, double maximum)
{
  const double scale = std::exp2(exposure);
  for (std::size_t i = 0; i < picture.Rgb.size(); i += 3)
  {
    float* pixel = &picture.Rgb[i];
    const double brightest = scale * *std::max_element(pixel, pixel + 3);
    const double factor = maximum > 0.0 && brightest > maximum ? scale * maximum / brightest : scale;
    for (int channel = 0; channel < 3; ++channel)
    {
      pixel[channel] = static_cast<float>(pixel[channel] * factor);
    }
  }
}

/// Weights for averaging values on `from` equal intervals of [0, 1] to `to` equal intervals. The value of new interval
/// k is the mean of the old intervals from First[k] on, with the weights Weights[k], whose sum is 1.
struct Overlaps
{
  std::vector<std::size_t> First;
  std::vector<std::vector<double>> Weights;

  /// Computes the weights.
  /// @param measure  increasing function on [0, 1]; an interval [a, b] has the weight measure(b) - measure(a)
  template <typename Measure>
  Overlaps(int from, int to, Measure&& measure)
  {
    for (int k = 0; k < to; ++k)
    {
      const double low = double(k) / to, high = double(k + 1) / to;
      const int first = std::min(from - 1, static_cast<int>(low * from));
      std::vector<double> weights;
      for (int i = first; i < from && double(i) / from < high; ++i)
      {
        const double a = std::max(low, double(i) / from), b = std::min(high, double(i + 1) / from);
        weights.push_back(std::max(0.0, (measure(b) - measure(a)) / (measure(high) - measure(low))));
      }
      this->First.push_back(static_cast<std::size_t>(first));
      this->Weights.push_back(std::move(weights));
    }
  }
};

/// Averages a picture, weighted by solid angle, over the larger pixels of a smaller picture.
RadiancePicture Shrink(const RadiancePicture& picture, const PictureSize& size)
{
  const Overlaps columns(picture.Width, size.Width, [](double u) { return u; });
  const Overlaps rows(picture.Height, size.Height, [](double v) { return -std::cos(vtkMath::Pi() * v); });
  RadiancePicture small{ size.Width, size.Height, {} };
  small.Rgb.reserve(3 * static_cast<std::size_t>(size.Width) * static_cast<std::size_t>(size.Height));
  for (std::size_t j = 0; j < rows.First.size(); ++j)
  {
    for (std::size_t i = 0; i < columns.First.size(); ++i)
    {
      double mean[3] = { 0.0, 0.0, 0.0 };
      for (std::size_t y = 0; y < rows.Weights[j].size(); ++y)
      {
        const std::size_t row = (rows.First[j] + y) * static_cast<std::size_t>(picture.Width);
        for (std::size_t x = 0; x < columns.Weights[i].size(); ++x)
        {
          const float* pixel = &picture.Rgb[3 * (row + columns.First[i] + x)];
          const double weight = rows.Weights[j][y] * columns.Weights[i][x];
          mean[0] += weight * pixel[0];
          mean[1] += weight * pixel[1];
          mean[2] += weight * pixel[2];
        }
      }
      small.Rgb.insert(small.Rgb.end(), { float(mean[0]), float(mean[1]), float(mean[2]) });
    }
  }
  return small;
}
}

vtkStandardNewMacro(vtkEnvironmentReader);

vtkEnvironmentReader::~vtkEnvironmentReader()
{
  delete[] this->FileName;
}

int vtkEnvironmentReader::CanReadFile(const char* fileName)
{
  return fileName != nullptr && KindOf(fileName) != Kind::Unknown;
}

int vtkEnvironmentReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  tyndall::GuardedInformation(this, [&] {
    const bool exr = KindToRead(this->FileName) == Kind::OpenExr;
    const PictureSize size =
      Shrunk(exr ? tyndall::SizeOfExr(this->FileName) : tyndall::SizeOfHdr(this->FileName), this->Width);
    extent[1] = size.Width - 1;
    extent[3] = size.Height - 1;
    extent[5] = 0;
  });
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  return 1;
}

int vtkEnvironmentReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    vtkImageData* image = vtkImageData::GetData(outputs);
    image->Initialize();
    const bool exr = KindToRead(this->FileName) == Kind::OpenExr;
    RadiancePicture picture = exr ? tyndall::ReadExr(this->FileName) : tyndall::ReadHdr(this->FileName);
    const std::size_t negative = Clean(picture, this->FileName);
    Expose(picture, this->Exposure, this->MaximumRadiance);
    const PictureSize size = Shrunk({ picture.Width, picture.Height }, this->Width);
    if (size.Width < picture.Width)
    {
      picture = Shrink(picture, size);
    }
    const auto pixelName = [&](std::size_t pixel) {
      const auto width = static_cast<std::size_t>(picture.Width);
      return "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ") from below";
    };
    tyndall::RequireFinite("radiance", picture.Rgb.data(), picture.Rgb.size(), 3, pixelName,
      "The picture, brightened by Exposure, is more than a float holds (3.4e+38): give Exposure less, or set "
      "MaximumRadiance.");

    image->SetDimensions(picture.Width, picture.Height, 1);
    vtkNew<vtkFloatArray> radiance;
    radiance->SetName("radiance");
    radiance->SetNumberOfComponents(3);
    radiance->SetNumberOfTuples(image->GetNumberOfPoints());
    std::copy(picture.Rgb.begin(), picture.Rgb.end(), radiance->GetPointer(0));
    image->GetPointData()->SetScalars(radiance);
    if (negative > 0)
    {
      vtkWarningMacro(<< negative << " values of \"" << this->FileName << "\" are negative; they were set to 0.");
    }
  });
}

void vtkEnvironmentReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  tyndallPrintMacro(Exposure, MaximumRadiance, Width);
}
