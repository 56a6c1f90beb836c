#ifndef PropertyRange_h
#define PropertyRange_h

#include "vtkTyndallModule.h" // for export macro

#include "vtkType.h"

#include <initializer_list>
#include <limits>
#include <string>

class vtkAlgorithm;

/// Properties of filters that have a range.
///
/// What every filter of Tyndall does with a number out of its range, wherever it comes from (ParaView's panel, Python,
/// C++): it refuses it. A setter never replaces what it is told by another value, and no filter works with a value it
/// was not told. The property keeps what it was set to; the next update ends with one error of VTK that names the
/// property, the value and the range, and empty outputs. A value in the range heals it. A number that is not finite is
/// never in a range.
///
/// Ranges that a setter can say stand in its macro, below. What only the work can say (a square number, a camera that
/// looks along its view up, a sum of two properties) is refused there, in the same way.
namespace tyndall
{
constexpr double AnyHigh = std::numeric_limits<double>::max();   ///< no upper bound, but finite
constexpr double AnyLow = -AnyHigh;                              ///< no lower bound, but finite
constexpr double AboveZero = std::numeric_limits<double>::min(); ///< lower bound of what must be positive
constexpr double LargestFloat =
  std::numeric_limits<float>::max(); ///< upper bound of light and coefficients, which are floats

/// Notes whether a property has a value out of its range, for CheckProperties.
TYNDALL_EXPORT void NoteProperty(
  vtkAlgorithm* filter, const char* property, const double* values, int count, double low, double high);

/// How a filter reads arrays of points; see tyndallPointDataMacro.
enum PointDataKind
{
  VoxelsAroundPoints = 0,
  AverageToCells = 1,
};

/// What the setter of that does. @return whether the property has changed
TYNDALL_EXPORT bool SetPointData(vtkAlgorithm* filter, int& held, int kind);

/// What a filter was told by it.
PointDataKind PointDataOf(vtkAlgorithm* filter);

/// To be asked before a filter works; Guarded does.
/// @throws InvalidInput that names every property out of its range, its value and its range
void CheckProperties(vtkAlgorithm* filter);

/// What the setters below do.
/// @return whether the property has changed
template <class Type>
bool SetInRange(vtkAlgorithm* filter, const char* property, Type* heldValues, std::initializer_list<Type> values,
  double low, double high)
{
  double asked[6];
  bool changed = false;
  int i = 0;
  for (const Type value : values)
  {
    Type& held = heldValues[i];
    changed = changed || !(held == value || (held != held && value != value)); // a NaN is the same as another one
    held = value;
    asked[i++] = static_cast<double>(value);
  }
  NoteProperty(filter, property, asked, i, low, high);
  return changed;
}
}

/// Instead of vtkSetMacro and vtkSetClampMacro: a number in [low, high].
#define tyndallSetRangeMacro(name, type, low, high)                                \
  virtual void Set##name(type value)                                               \
  {                                                                                \
    if (tyndall::SetInRange<type>(this, #name, &this->name, { value }, low, high)) \
    {                                                                              \
      this->Modified();                                                            \
    }                                                                              \
  }

/// The same with its Get.
#define tyndallRangeMacro(name, type, low, high)                       \
  tyndallSetRangeMacro(name, type, low, high) virtual type Get##name() \
  {                                                                    \
    return this->name;                                                 \
  }

/// Instead of vtkSetMacro, vtkGetMacro and vtkBooleanMacro of a bool.
#define tyndallFlagMacro(name)    \
  virtual void Set##name(bool on) \
  {                               \
    if (this->name != on)         \
    {                             \
      this->name = on;            \
      this->Modified();           \
    }                             \
  }                               \
  virtual bool Get##name()        \
  {                               \
    return this->name;            \
  }                               \
  virtual void name##On()         \
  {                               \
    this->Set##name(true);        \
  }                               \
  virtual void name##Off()        \
  {                               \
    this->Set##name(false);       \
  }

/// Instead of vtkSetVector2Macro: two numbers, each in [low, high].
#define tyndallSetRange2Macro(name, type, low, high)                                      \
  virtual void Set##name(type first, type second)                                         \
  {                                                                                       \
    if (tyndall::SetInRange<type>(this, #name, this->name, { first, second }, low, high)) \
    {                                                                                     \
      this->Modified();                                                                   \
    }                                                                                     \
  }                                                                                       \
  void Set##name(const type values[2])                                                    \
  {                                                                                       \
    this->Set##name(values[0], values[1]);                                                \
  }

/// Instead of vtkSetVector3Macro: three numbers, each in [low, high].
#define tyndallSetRange3Macro(name, type, low, high)                                             \
  virtual void Set##name(type first, type second, type third)                                    \
  {                                                                                              \
    if (tyndall::SetInRange<type>(this, #name, this->name, { first, second, third }, low, high)) \
    {                                                                                            \
      this->Modified();                                                                          \
    }                                                                                            \
  }                                                                                              \
  void Set##name(const type values[3])                                                           \
  {                                                                                              \
    this->Set##name(values[0], values[1], values[2]);                                            \
  }

/// Instead of vtkSetVector6Macro: six numbers, each in [low, high].
#define tyndallSetRange6Macro(name, type, low, high)                                                                   \
  virtual void Set##name(type first, type second, type third, type fourth, type fifth, type sixth)                     \
  {                                                                                                                    \
    if (tyndall::SetInRange<type>(this, #name, this->name, { first, second, third, fourth, fifth, sixth }, low, high)) \
    {                                                                                                                  \
      this->Modified();                                                                                                \
    }                                                                                                                  \
  }                                                                                                                    \
  void Set##name(const type values[6])                                                                                 \
  {                                                                                                                    \
    this->Set##name(values[0], values[1], values[2], values[3], values[4], values[5]);                                 \
  }

/// The property PointData: what arrays of points are. 0 (default): each point is in the middle of a voxel of its value,
/// so that n points are n voxels and bounds are half a spacing wider, and arrays of points become cells of the output;
/// 1: a voxel is between points, and has their mean, n - 1 voxels. Where an array of cells is read as well, voxels are
/// the cells, and points are averaged.
#define tyndallPointDataMacro()                             \
  virtual void SetPointData(int kind)                       \
  {                                                         \
    if (tyndall::SetPointData(this, this->PointData, kind)) \
    {                                                       \
      this->Modified();                                     \
    }                                                       \
  }                                                         \
  virtual int GetPointData()                                \
  {                                                         \
    return this->PointData;                                 \
  }

/// An optional input by connection or as data; null: none.
#define tyndallInputMacro(name, port)                    \
  void Set##name##Connection(vtkAlgorithmOutput* output) \
  {                                                      \
    this->SetInputConnection(port, output);              \
  }                                                      \
  void Set##name##Data(vtkDataObject* data)              \
  {                                                      \
    this->SetInputDataObject(port, data);                \
  }                                                      \
  void Remove##name()                                    \
  {                                                      \
    this->SetInputConnection(port, nullptr);             \
  }

/// The property Device, of the member of that name: part of the name of the OpenCL device to use, of any case. Default
/// empty: what the variable TYNDALL_DEVICE names, or else PoCL's CPU device.
#define tyndallDeviceMacro()                     \
  virtual void SetDevice(const char* name)       \
  {                                              \
    const std::string device = name ? name : ""; \
    if (this->Device != device)                  \
    {                                            \
      this->Device = device;                     \
      this->Modified();                          \
    }                                            \
  }                                              \
  virtual const char* GetDevice()                \
  {                                              \
    return this->Device.c_str();                 \
  }

#endif
