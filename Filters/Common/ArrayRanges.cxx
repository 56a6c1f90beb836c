#include "Common/ArrayRanges.h"

#include "Device/HostThreads.h"

#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <mutex>

namespace tyndall
{
namespace
{
/// Number of values in a block. A thread passes over each block twice: first to test for infinity and NaN, then to
/// compute extremes and norms. A block is small enough to stay in the processor's cache between the two passes.
constexpr std::size_t BlockValues = 8192;
constexpr std::size_t ThreadValues = 65536; ///< minimum number of values that one thread processes
/// Minimum number of lanes for the extremes of a block. With n lanes, lane k holds the smallest and the largest of the
/// values k, k + n, k + 2 n, ..., so that the loop over lanes has no dependences and is vectorised. 32 lanes suffice
/// for vector units of any width.
constexpr std::size_t Lanes = 32;

/// Whether any of `count` floating-point numbers is infinite or NaN: all bits of its exponent (mask `exponent`) are 1.
/// The loop is written for vectorisation.
template <class Bits>
bool HasExponent(const void* values, std::size_t count, Bits exponent)
{
  const auto* const bytes = static_cast<const char*>(values);
  Bits any = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    Bits bits;
    std::memcpy(&bits, bytes + i * sizeof(Bits), sizeof(Bits));
    any |= (bits & exponent) == exponent ? 1u : 0u;
  }
  return any != 0;
}

bool HasNotFinite(const float* values, std::size_t count)
{
  return HasExponent<std::uint32_t>(values, count, 0x7f800000u);
}

bool HasNotFinite(const double* values, std::size_t count)
{
  return HasExponent<std::uint64_t>(values, count, 0x7ff0000000000000u);
}

template <class Integer>
bool HasNotFinite(const Integer*, std::size_t)
{
  return false;
}

/// Smallest and largest value of each component, and of the tuples' norm, among the values that one thread has
/// processed.
template <class T>
class SeenValues
{
public:
  explicit SeenValues(std::size_t components)
    : Lowest(components, std::numeric_limits<T>::max())
    , Highest(components, std::numeric_limits<T>::lowest())
    , Width((Lanes + components - 1) / components * components)
    , LaneLowest(this->Width)
    , LaneHighest(this->Width)
  {
  }

  /// Updates the extremes with the values of one block.
  /// @param values  complete tuples of finite values
  void Add(const T* values, std::size_t count)
  {
    const std::size_t components = this->Lowest.size();
    this->FindExtremesOfLanes(values, count);
    // Bounds of the squared norms of the block's tuples, from the extremes of their components. Rounding is monotonic,
    // so that the bounds hold for rounded norms as well.
    double least = 0.0, most = 0.0;
    for (std::size_t c = 0; c < components; ++c)
    {
      T low = this->LaneLowest[c], high = this->LaneHighest[c];
      for (std::size_t lane = c + components; lane < this->Width; lane += components)
      {
        low = std::min(low, this->LaneLowest[lane]);
        high = std::max(high, this->LaneHighest[lane]);
      }
      this->Lowest[c] = std::min(this->Lowest[c], low);
      this->Highest[c] = std::max(this->Highest[c], high);
      const double a = low, b = high;
      least += a <= 0.0 && b >= 0.0 ? 0.0 : std::min(a * a, b * b);
      most += std::max(a * a, b * b);
    }
    if (components > 1 && (least < this->LeastSquare || most > this->LargestSquare))
    {
      this->AddNorms(values, count);
    }
  }

  void AddTo(SeenValues& all) const
  {
    for (std::size_t c = 0; c < this->Lowest.size(); ++c)
    {
      all.Lowest[c] = std::min(all.Lowest[c], this->Lowest[c]);
      all.Highest[c] = std::max(all.Highest[c], this->Highest[c]);
    }
    all.LeastSquare = std::min(all.LeastSquare, this->LeastSquare);
    all.LargestSquare = std::max(all.LargestSquare, this->LargestSquare);
  }

  ArrayRanges Ranges() const
  {
    ArrayRanges ranges;
    for (std::size_t c = 0; c < this->Lowest.size(); ++c)
    {
      ranges.components.push_back({ static_cast<double>(this->Lowest[c]), static_cast<double>(this->Highest[c]) });
    }
    ranges.norm = { std::sqrt(this->LeastSquare), std::sqrt(this->LargestSquare) };
    return ranges;
  }

private:
  void FindExtremesOfLanes(const T* values, std::size_t count)
  {
    const std::size_t components = this->Lowest.size(), width = this->Width;
    T* const low = this->LaneLowest.data();
    T* const high = this->LaneHighest.data();
    for (std::size_t lane = 0; lane < width; ++lane)
    {
      low[lane] = high[lane] = values[lane % components];
    }
    std::size_t i = 0;
    for (; i + width <= count; i += width)
    {
      for (std::size_t lane = 0; lane < width; ++lane)
      {
        const T value = values[i + lane];
        low[lane] = value < low[lane] ? value : low[lane];
        high[lane] = value > high[lane] ? value : high[lane];
      }
    }
    for (std::size_t lane = 0; i < count; ++i, ++lane)
    {
      low[lane] = std::min(low[lane], values[i]);
      high[lane] = std::max(high[lane], values[i]);
    }
  }

  void AddNorms(const T* values, std::size_t count)
  {
    const std::size_t components = this->Lowest.size();
    double least = this->LeastSquare, largest = this->LargestSquare;
    for (std::size_t i = 0; i < count; i += components)
    {
      double square = 0.0;
      for (std::size_t c = 0; c < components; ++c)
      {
        const double value = values[i + c];
        square += value * value;
      }
      least = square < least ? square : least;
      largest = square > largest ? square : largest;
    }
    this->LeastSquare = least;
    this->LargestSquare = largest;
  }

  std::vector<T> Lowest, Highest; ///< smallest and largest value of each component so far
  double LeastSquare = std::numeric_limits<double>::max(), LargestSquare = 0.0;
  std::size_t Width; ///< number of lanes (see Lanes), a multiple of the number of components
  std::vector<T> LaneLowest, LaneHighest;
};

template <class T>
ArrayRanges FindRanges(const T* values, std::size_t count, int components)
{
  const auto width = static_cast<std::size_t>(components);
  SeenValues<T> all(width);
  std::size_t firstNotFinite = count;
  std::mutex mutex;
  const std::size_t ofBlock = std::max<std::size_t>(BlockValues / width, 1);
  InThreads(count / width, ThreadValues / width, [&](std::size_t begin, std::size_t end) {
    SeenValues<T> seen(width);
    std::size_t bad = count;
    for (std::size_t tuple = begin; tuple < end && bad == count; tuple += ofBlock)
    {
      const T* const from = values + tuple * width;
      const std::size_t size = std::min(ofBlock, end - tuple) * width;
      if (HasNotFinite(from, size))
      {
        bad =
          std::find_if(from, from + size, [](T value) { return !std::isfinite(static_cast<double>(value)); }) - values;
      }
      else
      {
        seen.Add(from, size);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    seen.AddTo(all);
    firstNotFinite = std::min(firstNotFinite, bad);
  });
  ArrayRanges ranges = count > 0 ? all.Ranges() : ArrayRanges();
  ranges.firstNotFinite = firstNotFinite;
  return ranges;
}

template <class Array>
bool FindAndLeave(vtkDataArray* array)
{
  auto* const values = vtkArrayDownCast<Array>(array);
  if (values)
  {
    const auto count = static_cast<std::size_t>(values->GetNumberOfValues());
    const ArrayRanges ranges = FindRanges(values->GetPointer(0), count, values->GetNumberOfComponents());
    if (ranges.firstNotFinite == count)
    {
      LeaveRanges(ranges, values);
    }
  }
  return values != nullptr;
}
}

ArrayRanges RangesOf(const float* values, std::size_t count, int components)
{
  return FindRanges(values, count, components);
}

void LeaveRanges(const ArrayRanges& ranges, vtkDataArray* array)
{
  if (ranges.components.empty())
  {
    return;
  }
  vtkInformation* const information = array->GetInformation();
  for (vtkInformationInformationVectorKey* key :
    { vtkDataArray::PER_COMPONENT(), vtkDataArray::PER_FINITE_COMPONENT() })
  {
    auto* const all = vtkInformationVector::New();
    all->SetNumberOfInformationObjects(static_cast<int>(ranges.components.size()));
    for (std::size_t c = 0; c < ranges.components.size(); ++c)
    {
      all->GetInformationObject(static_cast<int>(c))
        ->Set(vtkDataArray::COMPONENT_RANGE(), ranges.components[c].data(), 2);
    }
    information->Set(key, all);
    all->FastDelete(); // faster than Delete, which would search for reference cycles
  }
  if (ranges.components.size() > 1)
  {
    information->Set(vtkDataArray::L2_NORM_RANGE(), ranges.norm.data(), 2);
    information->Set(vtkDataArray::L2_NORM_FINITE_RANGE(), ranges.norm.data(), 2);
  }
}

void LeaveSameRanges(vtkDataArray* from, vtkDataArray* array)
{
  vtkInformation* const information = from->GetInformation();
  for (vtkInformationKey* key : std::initializer_list<vtkInformationKey*>{ vtkDataArray::PER_COMPONENT(),
         vtkDataArray::PER_FINITE_COMPONENT(), vtkDataArray::L2_NORM_RANGE(), vtkDataArray::L2_NORM_FINITE_RANGE() })
  {
    array->GetInformation()->CopyEntry(information, key, 1);
  }
}

void LeaveRanges(vtkDataArray* array)
{
  FindAndLeave<vtkFloatArray>(array) || FindAndLeave<vtkDoubleArray>(array) || FindAndLeave<vtkIntArray>(array) ||
    FindAndLeave<vtkUnsignedCharArray>(array);
}
}
