#include "PictureWriting.h"

#include "Common/ArrayRanges.h"
#include "Common/LightTransportData.h"
#include "Common/LightTransportWriting.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <string>
#include <tuple>
#include <utility>

namespace tyndall
{
void WritePicture(
  Picture&& picture, const std::array<int, 2>& first, std::vector<std::uint8_t>&& color, vtkImageData* output)
{
  output->SetExtent(first[0], first[0] + picture.width - 1, first[1], first[1] + picture.height - 1, 0, 0);
  output->SetOrigin(0.0, 0.0, 0.0);
  output->SetSpacing(1.0, 1.0, 1.0);
  output->SetDirectionMatrix(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  vtkPointData* const pixels = output->GetPointData();
  const auto shown = ArrayOf<vtkUnsignedCharArray>("color", std::move(color), 4);
  LeaveRanges(shown);
  pixels->SetScalars(shown);
  const auto pixelName = [&first, width = static_cast<std::size_t>(picture.width)](std::size_t pixel) {
    return "pixel (" + std::to_string(first[0] + pixel % width) + ", " + std::to_string(first[1] + pixel / width) +
      ") from below";
  };
  for (const auto& [name, values, components] : { std::tuple("radiance", &picture.radiance, 3),
         std::tuple("alpha", &picture.alpha, 1), std::tuple("depth", &picture.depth, 1) })
  {
    const ArrayRanges ranges = RequireFinite(name, values->data(), values->size(), components, pixelName);
    const auto array = ArrayOf<vtkFloatArray>(name, std::move(*values), components);
    LeaveRanges(ranges, array);
    pixels->AddArray(array);
  }
}
}
