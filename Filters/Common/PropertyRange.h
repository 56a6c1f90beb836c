#ifndef PropertyRange_h
#define PropertyRange_h

#include "vtkTyndallModule.h" // for export macro

#include "vtkType.h"

#include <initializer_list>
#include <limits>
#include <string>

class vtkAlgorithm;

/// Properties of filters with a valid range.
///
/// Every filter of Tyndall refuses a number that is out of its range, whether it comes from ParaView's panel, Python or
/// C++. A setter stores any value unchanged, and no filter replaces it by another. After an invalid value, the next
/// update ends with one VTK error that names property, value and range, and the outputs are empty. Setting a valid
/// value clears the error. A number that is not finite is out of every range.
///
/// Ranges known to the setter are given in the macros below. Conditions that only RequestData can check (a number that
/// must be a square, a camera that looks along its view up, a sum of two properties) are refused there in the same way.
namespace tyndall
{
/// Upper bound of a property without upper limit; infinity is out of range.
constexpr double AnyHigh = std::numeric_limits<double>::max();
/// Lower bound of a property without lower limit; -infinity is out of range.
constexpr double AnyLow = -AnyHigh;
constexpr double AboveZero = std::numeric_limits<double>::min(); ///< lower bound of values that must be positive
constexpr double LargestFloat =
  std::numeric_limits<float>::max(); ///< upper bound of radiances, powers and optical coefficients, which are floats

/// Records for CheckProperties whether a property's `count` values are in [low, high].
TYNDALL_EXPORT void NoteProperty(
  vtkAlgorithm* filter, const char* property, const double* values, int count, double low, double high);

/// Values of the property PointData: how a filter reads point arrays (tyndallPointDataMacro).
enum PointDataKind
{
  VoxelsAroundPoints = 0,
  AverageToCells = 1,
};

/// Implements SetPointData of tyndallPointDataMacro: stores `kind` in `held`, the filter's member.
/// @return whether the property has changed
TYNDALL_EXPORT bool SetPointData(vtkAlgorithm* filter, int& held, int kind);

/// Value of the property PointData of a filter.
PointDataKind PointDataOf(vtkAlgorithm* filter);

// Results of a filter's last run, shown on its panel: run time and skipped computations. Guarded (Pieces/GuardedWork.h)
// measures the run time, and resets both results if the run fails or is aborted. The filter itself reports the
// computations that it skipped.

/// Wall-clock time of the last run in seconds, from the inputs to the outputs; 0 if it failed.
TYNDALL_EXPORT double SecondsOfRun(vtkAlgorithm* filter);
/// Computations that the last run skipped because the scene did not need them, one per line.
TYNDALL_EXPORT const char* LeftOutOfRun(vtkAlgorithm* filter);
void NoteSeconds(vtkAlgorithm* filter, double seconds);
void NoteLeftOut(vtkAlgorithm* filter, const std::string& lines);

/// Checks that all properties are in their ranges. Called by Guarded before a filter works.
/// @throws InvalidInput that names every property out of its range, with its value and range
void CheckProperties(vtkAlgorithm* filter);

/// Implements the setters of the macros tyndallSet...Macro: stores the values, and records whether they are in [low,
/// high].
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
    changed = changed || !(held == value || (held != held && value != value)); // two NaNs count as equal
    held = value;
    asked[i++] = static_cast<double>(value);
  }
  NoteProperty(filter, property, asked, i, low, high);
  return changed;
}
}

/// Setter of a property that is a number in [low, high]; replaces vtkSetMacro and vtkSetClampMacro.
#define tyndallSetRangeMacro(name, type, low, high)                                \
  virtual void Set##name(type value)                                               \
  {                                                                                \
    if (tyndall::SetInRange<type>(this, #name, &this->name, { value }, low, high)) \
    {                                                                              \
      this->Modified();                                                            \
    }                                                                              \
  }

/// Setter (tyndallSetRangeMacro) and Get method of a property that is a number in [low, high].
#define tyndallRangeMacro(name, type, low, high)                       \
  tyndallSetRangeMacro(name, type, low, high) virtual type Get##name() \
  {                                                                    \
    return this->name;                                                 \
  }

/// Setter, Get, On and Off method of a property that is a bool; replaces vtkSetMacro, vtkGetMacro and vtkBooleanMacro.
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

/// Setter of a property of two numbers, each in [low, high]; replaces vtkSetVector2Macro.
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

/// Setter of a property of three numbers, each in [low, high]; replaces vtkSetVector3Macro.
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

/// Setter of a property of six numbers, each in [low, high]; replaces vtkSetVector6Macro.
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

/// The property PointData: how point arrays are read. 0 (default): each point is the centre of a voxel with its value;
/// n points along an axis are n voxels, bounds are half a spacing wider on each side, and point arrays become cell
/// arrays of the output. 1: voxels are the cells between points, n - 1 voxels, with the mean value of their points. If
/// a cell array is read as well, voxels are the cells, and point arrays are averaged.
#define tyndallPointDataMacro()                             \
  enum PointDataKinds                                       \
  {                                                         \
    VOXELS_AROUND_POINTS = 0,                               \
    AVERAGE_TO_CELLS = 1                                    \
  };                                                        \
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

/// The properties of a picture and of its camera, stored in members of the same names. ImageSize: columns and rows,
/// pixels, valid from 1 on. CameraPosition and CameraFocalPoint: as in vtkCamera. CameraViewUp: direction that is
/// upwards in the picture, valid if not parallel to the view direction. CameraViewAngle: angle between the picture's
/// lower and upper edge, degrees, valid (0, 180). CameraSetOn (Viewing/CasterProperties.h) reads the camera.
#define tyndallCameraMacro()                                                          \
  tyndallSetRange2Macro(ImageSize, int, 1, VTK_INT_MAX);                              \
  vtkGetVector2Macro(ImageSize, int);                                                 \
  tyndallSetRange3Macro(CameraPosition, double, tyndall::AnyLow, tyndall::AnyHigh);   \
  vtkGetVector3Macro(CameraPosition, double);                                         \
  tyndallSetRange3Macro(CameraFocalPoint, double, tyndall::AnyLow, tyndall::AnyHigh); \
  vtkGetVector3Macro(CameraFocalPoint, double);                                       \
  tyndallSetRange3Macro(CameraViewUp, double, tyndall::AnyLow, tyndall::AnyHigh);     \
  vtkGetVector3Macro(CameraViewUp, double);                                           \
  tyndallRangeMacro(CameraViewAngle, double, tyndall::AboveZero, 180.0)

/// Methods that set an optional input, by connection or as data, or remove it.
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

/// The read-only property Seconds: SecondsOfRun.
#define tyndallSecondsMacro()           \
  virtual double GetSeconds()           \
  {                                     \
    return tyndall::SecondsOfRun(this); \
  }

/// The read-only property LeftOut: LeftOutOfRun.
#define tyndallLeftOutMacro()           \
  virtual const char* GetLeftOut()      \
  {                                     \
    return tyndall::LeftOutOfRun(this); \
  }

/// The property Device, stored in the member of that name: part of the name of the OpenCL device to use; case does not
/// matter. Default empty: the device that the environment variable TYNDALL_DEVICE names, or else PoCL's CPU device.
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
