#include "Common/ImageAxes.h"

#include "Common/ArrayRanges.h"
#include "Common/ImageInput.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportData.h"
#include "Device/HostThreads.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace tyndall
{
namespace
{
/// Key in a filter's information: the medium axes (OwnAxes), in which the filter works. NoteOwnAxes sets it.
vtkInformationDoubleVectorKey* AxesOfFilter()
{
  static auto* const key = vtkInformationDoubleVectorKey::MakeKey("OWN_AXES", "Tyndall");
  return key;
}

constexpr double Aslant = 1e-6; ///< tolerance of direction cosines: an axis is oblique unless they are 0, 1 or -1

/// Order of the values (cells or points) in the image that Aligned() makes, whose axes are the world axes: for each
/// value its index in the given image.
/// @param count  number of values along each image axis
vtkSmartPointer<vtkIdList> OrderOf(const AxisWays& ways, const std::array<vtkIdType, 3>& count)
{
  const std::array<vtkIdType, 3> stride = { 1, count[0], count[0] * count[1] };
  // For each world axis: number of values along it, index in the given image of the first value, and difference of the
  // indices of neighbouring values.
  std::array<vtkIdType, 3> counts, first, step;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int world = ways.world[axis];
    counts[world] = count[axis];
    first[world] = ways.down[axis] ? (count[axis] - 1) * stride[axis] : 0;
    step[world] = ways.down[axis] ? -stride[axis] : stride[axis];
  }
  auto order = vtkSmartPointer<vtkIdList>::New();
  order->SetNumberOfIds(count[0] * count[1] * count[2]);
  vtkIdType* to = order->GetPointer(0);
  for (vtkIdType k = 0; k < counts[2]; ++k)
  {
    for (vtkIdType j = 0; j < counts[1]; ++j)
    {
      const vtkIdType row = first[0] + first[1] + first[2] + k * step[2] + j * step[1];
      for (vtkIdType i = 0; i < counts[0]; ++i)
      {
        *to++ = row + i * step[0];
      }
    }
  }
  return order;
}

void CopyInOrder(vtkDataSetAttributes* from, vtkIdList* order, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const values = from->GetAbstractArray(i);
    if (values->GetNumberOfTuples() != order->GetNumberOfIds())
    {
      continue;
    }
    const auto ordered = vtkSmartPointer<vtkAbstractArray>::Take(values->NewInstance());
    ordered->SetName(values->GetName());
    ordered->SetNumberOfComponents(values->GetNumberOfComponents());
    ordered->SetNumberOfTuples(order->GetNumberOfIds());
    values->GetTuples(order, ordered);
    to->AddArray(ordered);
  }
  vtkDataArray* const active = from->GetScalars();
  if (active && active->GetName())
  {
    to->SetActiveScalars(active->GetName());
  }
}
}

bool AxisWays::AreAlike() const
{
  return this->world == std::array<int, 3>{ 0, 1, 2 } && this->down == std::array<bool, 3>{};
}

std::array<int, 6> AxisWays::Extent(const int* ofImage) const
{
  std::array<int, 6> extent;
  const bool any = ofImage[0] <= ofImage[1] && ofImage[2] <= ofImage[3] && ofImage[4] <= ofImage[5];
  for (int axis = 0; axis < 3; ++axis)
  {
    const int low = ofImage[2 * axis], high = ofImage[2 * axis + 1];
    const bool turned = any && this->down[axis];
    extent[2 * this->world[axis]] = turned ? -high : low;
    extent[2 * this->world[axis] + 1] = turned ? -low : high;
  }
  return extent;
}

std::optional<AxisWays> WaysOf(const double* spacing, const double* direction)
{
  AxisWays ways;
  for (int axis = 0; axis < 3; ++axis)
  {
    int along = -1;
    for (int row = 0; row < 3; ++row)
    {
      const double cosine = direction ? direction[3 * row + axis] : row == axis ? 1.0 : 0.0;
      if (std::abs(std::abs(cosine) - 1.0) <= Aslant)
      {
        along = row;
        ways.down[axis] = (cosine < 0.0) != (spacing[axis] < 0.0);
      }
      else if (!(std::abs(cosine) <= Aslant))
      {
        return std::nullopt;
      }
    }
    if (along < 0 || !(std::abs(spacing[axis]) > 0.0) || std::isinf(spacing[axis]))
    {
      return std::nullopt;
    }
    ways.world[axis] = along;
    ways.spacing[along] = std::abs(spacing[axis]);
  }
  const bool each = ways.world[0] + ways.world[1] + ways.world[2] == 3 && ways.world[0] != ways.world[1];
  return each ? std::optional<AxisWays>(ways) : std::nullopt;
}

vtkSmartPointer<vtkImageData> Aligned(vtkImageData* image)
{
  const double* const direction = image->GetDirectionMatrix()->GetData();
  const std::optional<AxisWays> ways = WaysOf(image->GetSpacing(), direction);
  if (!ways || image->GetNumberOfPoints() == 0 || (ways->AreAlike() && image->GetDirectionMatrix()->IsIdentity()))
  {
    return image;
  }
  auto aligned = vtkSmartPointer<vtkImageData>::New();
  std::array<vtkIdType, 3> points, cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    points[axis] = image->GetDimensions()[axis];
    cells[axis] = std::max<vtkIdType>(points[axis] - 1, 1);
  }
  aligned->SetExtent(ways->Extent(image->GetExtent()).data());
  aligned->SetOrigin(image->GetOrigin());
  aligned->SetSpacing(ways->spacing.data());
  CopyInOrder(image->GetCellData(), OrderOf(*ways, cells), aligned->GetCellData());
  CopyInOrder(image->GetPointData(), OrderOf(*ways, points), aligned->GetPointData());
  aligned->SetFieldData(image->GetFieldData());
  aligned->GetInformation()->CopyEntry(image->GetInformation(), vtkDataObject::DATA_TIME_STEP());
  return aligned;
}

namespace
{
constexpr double AlmostRigid = 1e-4; ///< tolerance of M^T M = 1 for a direction matrix M to count as a rotation

/// Product a^T b.
Rotation TransposedTimes(const Rotation& a, const Rotation& b)
{
  Rotation product = {};
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      for (int i = 0; i < 3; ++i)
      {
        product[row][column] += a[i][row] * b[i][column];
      }
    }
  }
  return product;
}

double FarthestFromUnit(const Rotation& matrix)
{
  double farthest = 0.0;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      const double off = std::abs(matrix[row][column] - (row == column ? 1.0 : 0.0));
      farthest = off <= farthest ? farthest : off; // this form of comparison counts NaN as farthest
    }
  }
  return farthest;
}

/// The nearest rotation to a matrix that is almost a rotation: Newton-Schulz iteration for the polar decomposition.
Rotation NextRotation(Rotation matrix)
{
  for (int step = 0; step < 4 && FarthestFromUnit(TransposedTimes(matrix, matrix)) > 1e-15; ++step)
  {
    Rotation half = TransposedTimes(matrix, matrix);
    for (int i = 0; i < 9; ++i)
    {
      half[i / 3][i % 3] = (i % 4 == 0 ? 1.5 : 0.0) - 0.5 * half[i / 3][i % 3];
    }
    Rotation transposed;
    for (int i = 0; i < 9; ++i)
    {
      transposed[i / 3][i % 3] = matrix[i % 3][i / 3];
    }
    matrix = TransposedTimes(transposed, half);
  }
  return matrix;
}

/// Direction matrix of an image for positive spacings: columns of axes with a negative spacing change their sign.
Rotation DirectionOf(vtkImageData* image)
{
  Rotation direction;
  for (int i = 0; i < 9; ++i)
  {
    const double element = image->GetDirectionMatrix()->GetData()[i];
    direction[i / 3][i % 3] = image->GetSpacing()[i % 3] < 0.0 ? -element : element;
  }
  return direction;
}

void SetDirection(vtkImageData* image, const Rotation& direction)
{
  double elements[9], spacing[3];
  for (int i = 0; i < 9; ++i)
  {
    elements[i] = direction[i / 3][i % 3];
    spacing[i % 3] = std::abs(image->GetSpacing()[i % 3]);
  }
  image->SetDirectionMatrix(elements);
  image->SetSpacing(spacing);
}

using Turn = std::function<OwnAxes::Vec(const OwnAxes::Vec&)>;

/// Index of the first component of a lamp's position, and of its direction, in a tuple of field data `lamps_apart`.
constexpr int LampPlace = 1, LampDirection = 4;

vtkSmartPointer<vtkDataArray> NewLike(vtkDataArray* array)
{
  auto made = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  made->SetName(array->GetName());
  made->SetNumberOfComponents(array->GetNumberOfComponents());
  made->CopyComponentNames(array);
  made->SetNumberOfTuples(array->GetNumberOfTuples());
  return made;
}

/// Applies `turn`, which transforms directions or positions, to the vectors in components `first` to `last` - 1 of each
/// tuple, three components per vector.
void TurnComponents(vtkDataArray* from, int first, int last, const Turn& turn, vtkDataArray* to)
{
  auto* const floats = vtkArrayDownCast<vtkFloatArray>(from);
  auto* const turned = vtkArrayDownCast<vtkFloatArray>(to);
  const int components = from->GetNumberOfComponents();
  InThreads(static_cast<std::size_t>(from->GetNumberOfTuples()), 16384, [&](std::size_t begin, std::size_t end) {
    OwnAxes::Vec vector;
    for (auto i = static_cast<vtkIdType>(begin); i < static_cast<vtkIdType>(end); ++i)
    {
      for (int c = first; c + 3 <= last; c += 3)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          vector[axis] = floats ? floats->GetValue(i * components + c + axis) : from->GetComponent(i, c + axis);
        }
        vector = turn(vector);
        for (int axis = 0; axis < 3; ++axis)
        {
          if (turned)
          {
            turned->SetValue(i * components + c + axis, static_cast<float>(vector[axis]));
          }
          else
          {
            to->SetComponent(i, c + axis, vector[axis]);
          }
        }
      }
    }
  });
}

vtkSmartPointer<vtkDataArray> TurnedArray(vtkDataArray* array, const Turn& turn)
{
  const vtkSmartPointer<vtkDataArray> turned = NewLike(array);
  TurnComponents(array, 0, array->GetNumberOfComponents(), turn, turned);
  LeaveRanges(turned);
  return turned;
}

/// Replaces array number `index` by the array `other` of the same name. If the old array was the active attribute, the
/// new one is.
void Replace(vtkDataSetAttributes* arrays, int index, vtkDataArray* other)
{
  const int attribute = arrays->IsArrayAnAttribute(index);
  arrays->AddArray(other);
  if (attribute >= 0)
  {
    arrays->SetActiveAttribute(other->GetName(), attribute);
  }
}

bool IsOfVectors(vtkDataArray* array)
{
  return array && array->GetName() && array->GetNumberOfComponents() % 3 == 0;
}

/// Transforms the vectors in an image's field data: directions by the rotation `way`, positions of lamps
/// (`lamps_apart`) by the transformation `place`.
/// @param note  whether the copies record the modification times of the original arrays (TimeBeforeTurning)
void TurnFacts(vtkImageData* image, const Turn& place, const Turn& way, bool note)
{
  vtkNew<vtkFieldData> own;
  own->ShallowCopy(image->GetFieldData());
  for (const char* name : { "stored_directions", "directions", LampsApartFact })
  {
    vtkDataArray* const array = own->GetArray(name);
    if (array && std::string(name) == LampsApartFact && array->GetNumberOfComponents() == LampComponents)
    {
      const vtkSmartPointer<vtkDataArray> lamps = NewLike(array);
      for (vtkIdType lamp = 0; lamp < array->GetNumberOfTuples(); ++lamp)
      {
        lamps->SetTuple(lamp, lamp, array);
      }
      TurnComponents(array, LampPlace, LampPlace + 3, place, lamps);
      TurnComponents(array, LampDirection, LampDirection + 3, way, lamps);
      own->AddArray(lamps);
      if (note)
      {
        lamps->GetInformation()->Set(TimeBeforeTurning(), TimeOf(array));
      }
    }
    else if (array && std::string(name) != LampsApartFact && array->GetNumberOfComponents() == 3)
    {
      own->AddArray(TurnedArray(array, way));
    }
  }
  image->SetFieldData(own);
}

constexpr const char* VectorNames[] = { "net_flux", "mean_direction", "ior_gradient" };

bool IsVectorName(const std::string& name)
{
  return std::find(std::begin(VectorNames), std::end(VectorNames), name) != std::end(VectorNames);
}

/// Name of the array that is selected as mean direction at an input port; empty: the default array.
std::string ChosenMeanDirection(vtkAlgorithm* filter, int port, vtkImageData* image)
{
  const std::vector<std::string> chosen = VoxelArraysOf(filter->GetInputPortInformation(port)).chosen;
  const auto number = std::find(chosen.begin(), chosen.end(), "mean_direction");
  vtkDataArray* const array = number == chosen.end()
    ? nullptr
    : ChosenArray(filter, static_cast<int>(number - chosen.begin()), image, "mean_direction");
  return array && array->GetName() ? array->GetName() : "";
}

/// Finds the array of `image` of which `turned` is the rotated copy, if it has the same number of tuples; null: not
/// found.
vtkDataArray* BeforeTurning(vtkDataArray* turned, vtkImageData* image)
{
  for (vtkDataSetAttributes* arrays : { static_cast<vtkDataSetAttributes*>(image ? image->GetCellData() : nullptr),
         static_cast<vtkDataSetAttributes*>(image ? image->GetPointData() : nullptr) })
  {
    vtkDataArray* const array = arrays ? arrays->GetArray(turned->GetName()) : nullptr;
    if (array && array->GetNumberOfTuples() == turned->GetNumberOfTuples() && TimeOf(array) == TimeOf(turned))
    {
      return array;
    }
  }
  return nullptr;
}
}

vtkSmartPointer<vtkImageData> WithSpacingsAbove0(vtkImageData* image)
{
  const double* const spacing = image->GetSpacing();
  if (std::none_of(spacing, spacing + 3, [](double along) { return along < 0.0; }))
  {
    return image;
  }
  auto same = vtkSmartPointer<vtkImageData>::New();
  same->ShallowCopy(image);
  SetDirection(same, DirectionOf(image));
  return same;
}

bool OwnAxes::AreMirrored() const
{
  return vtkMath::Determinant3x3(this->axes[0].data(), this->axes[1].data(), this->axes[2].data()) < 0.0;
}

OwnAxes::Vec OwnAxes::Way(const Vec& inScene) const
{
  Vec way;
  for (int axis = 0; axis < 3; ++axis)
  {
    way[axis] = vtkMath::Dot(this->axes[axis].data(), inScene.data());
  }
  return way;
}

OwnAxes::Vec OwnAxes::WayInScene(const Vec& way) const
{
  Vec inScene;
  for (int axis = 0; axis < 3; ++axis)
  {
    inScene[axis] = this->axes[0][axis] * way[0] + this->axes[1][axis] * way[1] + this->axes[2][axis] * way[2];
  }
  return inScene;
}

OwnAxes::Vec OwnAxes::Place(const Vec& inScene) const
{
  const Vec& o = this->origin;
  const Vec way = this->Way({ inScene[0] - o[0], inScene[1] - o[1], inScene[2] - o[2] });
  return { o[0] + way[0], o[1] + way[1], o[2] + way[2] };
}

OwnAxes::Vec OwnAxes::PlaceInScene(const Vec& place) const
{
  const Vec& o = this->origin;
  const Vec way = this->WayInScene({ place[0] - o[0], place[1] - o[1], place[2] - o[2] });
  return { o[0] + way[0], o[1] + way[1], o[2] + way[2] };
}

std::vector<double> OwnAxes::Words() const
{
  std::vector<double> words(this->origin.begin(), this->origin.end());
  for (const Vec& axis : this->axes)
  {
    words.insert(words.end(), axis.begin(), axis.end());
  }
  words.insert(words.end(), this->direction.begin(), this->direction.end());
  return words;
}

OwnAxes OwnAxes::From(const std::vector<double>& words)
{
  OwnAxes own;
  std::copy_n(words.begin(), 3, own.origin.begin());
  for (int axis = 0; axis < 3; ++axis)
  {
    std::copy_n(words.begin() + 3 + 3 * axis, 3, own.axes[axis].begin());
  }
  std::copy_n(words.begin() + 12, 9, own.direction.begin());
  return own;
}

OwnAxes OwnAxesOf(vtkImageData* image)
{
  OwnAxes own;
  if (!image || image->GetNumberOfPoints() == 0 || WaysOf(image->GetSpacing(), image->GetDirectionMatrix()->GetData()))
  {
    return own;
  }
  const Rotation direction = DirectionOf(image);
  if (!(FarthestFromUnit(TransposedTimes(direction, direction)) <= AlmostRigid))
  {
    return own;
  }
  std::copy_n(image->GetOrigin(), 3, own.origin.begin());
  const Rotation rotation = NextRotation(direction);
  for (int i = 0; i < 9; ++i)
  {
    own.direction[i] = direction[i / 3][i % 3];
    own.axes[i / 3][i % 3] = rotation[i % 3][i / 3];
  }
  return own;
}

OwnAxes OwnAxesOf(vtkAlgorithm* filter)
{
  vtkInformation* const facts = filter->GetInformation();
  if (!facts->Has(AxesOfFilter()))
  {
    return {};
  }
  const double* const words = facts->Get(AxesOfFilter());
  return OwnAxes::From({ words, words + facts->Length(AxesOfFilter()) });
}

void NoteOwnAxes(vtkAlgorithm* filter, const OwnAxes& axes)
{
  if (axes.AreThoseOfScene())
  {
    filter->GetInformation()->Remove(AxesOfFilter());
    return;
  }
  const std::vector<double> words = axes.Words();
  filter->GetInformation()->Set(AxesOfFilter(), words.data(), static_cast<int>(words.size()));
}

vtkSmartPointer<vtkImageData> InOwnAxes(vtkImageData* image, const OwnAxes& axes, vtkAlgorithm* filter, int port)
{
  if (axes.AreThoseOfScene() || !image || image->GetNumberOfPoints() == 0)
  {
    return image;
  }
  auto turned = vtkSmartPointer<vtkImageData>::New();
  PassOn(image, turned);
  turned->SetOrigin(axes.Place({ image->GetOrigin()[0], image->GetOrigin()[1], image->GetOrigin()[2] }).data());
  Rotation direction = {};
  const Rotation inScene = DirectionOf(image);
  for (int column = 0; column < 3; ++column)
  {
    const OwnAxes::Vec way = axes.Way({ inScene[0][column], inScene[1][column], inScene[2][column] });
    for (int row = 0; row < 3; ++row)
    {
      direction[row][column] = way[row];
    }
  }
  const bool same = FarthestFromUnit(direction) <= AlmostRigid;
  SetDirection(turned, same ? Rotation{ { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } } : direction);
  const Turn way = [&](const OwnAxes::Vec& vector) { return axes.Way(vector); };
  const Turn place = [&](const OwnAxes::Vec& point) { return axes.Place(point); };
  const std::string chosen = ChosenMeanDirection(filter, port, image);
  for (vtkDataSetAttributes* arrays : { static_cast<vtkDataSetAttributes*>(turned->GetCellData()),
         static_cast<vtkDataSetAttributes*>(turned->GetPointData()) })
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const array = arrays->GetArray(i);
      if (IsOfVectors(array) && (IsVectorName(array->GetName()) || array->GetName() == chosen))
      {
        const vtkSmartPointer<vtkDataArray> vectors = TurnedArray(array, way);
        vectors->GetInformation()->Set(TimeBeforeTurning(), TimeOf(array));
        Replace(arrays, i, vectors);
      }
    }
  }
  TurnFacts(turned, place, way, true);
  return turned;
}

void PutIntoScene(vtkImageData* output, const OwnAxes& axes, vtkImageData* given)
{
  if (axes.AreThoseOfScene() || !output || output->GetNumberOfPoints() == 0)
  {
    return;
  }
  const Turn way = [&](const OwnAxes::Vec& vector) { return axes.WayInScene(vector); };
  const Turn place = [&](const OwnAxes::Vec& point) { return axes.PlaceInScene(point); };
  for (vtkDataSetAttributes* arrays : { static_cast<vtkDataSetAttributes*>(output->GetCellData()),
         static_cast<vtkDataSetAttributes*>(output->GetPointData()) })
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const array = arrays->GetArray(i);
      const bool wasTurned = array && array->GetName() && array->GetInformation()->Has(TimeBeforeTurning());
      if (vtkDataArray* const before = wasTurned ? BeforeTurning(array, given) : nullptr)
      {
        Replace(arrays, i, before);
      }
      else if (wasTurned || (IsOfVectors(array) && IsVectorName(array->GetName())))
      {
        Replace(arrays, i, TurnedArray(array, way));
      }
    }
  }
  TurnFacts(output, place, way, false);
  output->SetOrigin(
    axes.PlaceInScene({ output->GetOrigin()[0], output->GetOrigin()[1], output->GetOrigin()[2] }).data());
  output->SetDirectionMatrix(axes.direction.data());
}

void PutIntoScene(vtkAlgorithm* filter, const OwnAxes& axes, vtkInformationVector* outputs, vtkImageData* given)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects() && !axes.AreThoseOfScene(); ++port)
  {
    vtkDataObject* const output = vtkDataObject::GetData(outputs, port);
    if (TakesPictures(filter->GetOutputPortInformation(port)))
    {
      continue;
    }
    PutIntoScene(vtkImageData::SafeDownCast(output), axes, given);
    if (output && output->IsA("vtkHyperTreeGrid") && output->GetNumberOfElements(vtkDataObject::CELL) > 0)
    {
      vtkWarningWithObjectMacro(filter, << "The tree grid, output " << port
                                        << ", lies along the axes of the image, not turned as the image is: VTK's have "
                                           "no direction. The levels of the image, output 0, are where they belong.");
    }
  }
}
}
