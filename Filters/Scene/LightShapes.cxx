#include "Scene/LightShapes.h"

#include "vtkCellArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall
{
namespace
{
using Vector = std::array<double, 3>;

constexpr int Sides = 16;       ///< number of sides of round shapes
constexpr int Bands = 8;        ///< number of bands of a ball, from pole to pole
constexpr double Shaft = 0.02;  ///< radius of an arrow's shaft, relative to the arrow's length
constexpr double Head = 0.06;   ///< radius of an arrow's head, relative to the arrow's length
constexpr double Neck = 0.75;   ///< distance of an arrow's head from the arrow's start, relative to the arrow's length
constexpr double Gamma = 2.2;   ///< gamma of a display
constexpr double Facing = 0.35; ///< length of a rectangle's arrow, relative to the rectangle's longer edge

Vector Along(const Vector& from, double factor, const Vector& direction)
{
  return { from[0] + factor * direction[0], from[1] + factor * direction[1], from[2] + factor * direction[2] };
}

std::array<unsigned char, 3> ColorOf(const Light& light)
{
  const double most = std::max({ light.power[0], light.power[1], light.power[2] });
  std::array<unsigned char, 3> color = { 60, 60, 60 }; // colour of a light without power
  for (int c = 0; c < 3 && most > 0.0; ++c)
  {
    color[c] = static_cast<unsigned char>(std::lround(255.0 * std::pow(light.power[c] / most, 1.0 / Gamma)));
  }
  return color;
}

/// Collects the lines and polygons of shapes, with the current colour (SetColor) as colour of their points.
class Drawing
{
public:
  Drawing()
  {
    this->Points->SetDataTypeToDouble();
    this->Colors->SetName("color");
    this->Colors->SetNumberOfComponents(3);
  }

  void SetColor(const std::array<unsigned char, 3>& color) { this->Color = color; }

  vtkIdType Point(const Vector& place)
  {
    this->Colors->InsertNextTypedTuple(this->Color.data());
    return this->Points->InsertNextPoint(place.data());
  }

  void Line(const Vector& from, const Vector& to)
  {
    this->Lines->InsertNextCell({ this->Point(from), this->Point(to) });
  }

  void Quad(const Vector& first, const Vector& second, const Vector& third, const Vector& fourth)
  {
    this->Polygons->InsertNextCell(
      { this->Point(first), this->Point(second), this->Point(third), this->Point(fourth) });
  }

  void MoveInto(vtkPolyData* output)
  {
    output->SetPoints(this->Points);
    output->SetLines(this->Lines);
    output->SetPolys(this->Polygons);
    output->GetPointData()->SetScalars(this->Colors);
  }

private:
  std::array<unsigned char, 3> Color = { 255, 255, 255 };
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkCellArray> Polygons;
  vtkNew<vtkUnsignedCharArray> Colors;
};

/// Computes points on circles about an axis, Sides points per circle.
class Rings
{
public:
  explicit Rings(const Vector& axis) { vtkMath::Perpendiculars(axis.data(), this->X.data(), this->Y.data(), 0.0); }

  Vector Place(const Vector& centre, double radius, int side) const
  {
    const double angle = 2.0 * vtkMath::Pi() * side / Sides;
    return Along(Along(centre, radius * std::cos(angle), this->X), radius * std::sin(angle), this->Y);
  }

private:
  Vector X;
  Vector Y;
};

/// Draws the surface between two circles about a common axis.
void Skin(
  Drawing& drawing, const Rings& rings, const Vector& from, double fromRadius, const Vector& to, double toRadius)
{
  for (int side = 0; side < Sides; ++side)
  {
    drawing.Quad(rings.Place(from, fromRadius, side), rings.Place(from, fromRadius, side + 1),
      rings.Place(to, toRadius, side + 1), rings.Place(to, toRadius, side));
  }
}

void Arrow(Drawing& drawing, const Vector& from, const Vector& direction, double length)
{
  const Rings rings(direction);
  const Vector neck = Along(from, Neck * length, direction);
  Skin(drawing, rings, from, Shaft * length, neck, Shaft * length);
  Skin(drawing, rings, neck, Shaft * length, neck, Head * length);
  Skin(drawing, rings, neck, Head * length, Along(from, length, direction), 0.0);
}

void Ball(Drawing& drawing, const Vector& centre, double radius)
{
  const Vector up = { 0.0, 0.0, 1.0 };
  const Rings rings(up);
  for (int band = 0; band < Bands; ++band)
  {
    const double low = vtkMath::Pi() * band / Bands;
    const double high = vtkMath::Pi() * (band + 1) / Bands;
    Skin(drawing, rings, Along(centre, -radius * std::cos(low), up), radius * std::sin(low),
      Along(centre, -radius * std::cos(high), up), radius * std::sin(high));
  }
}

/// Draws the outline of a spot light's cone.
/// @param length  length of the cone's edge lines, so that an angle of 180 degrees is drawn as a disc of that radius
void Cone(Drawing& drawing, const Light& light, double length)
{
  const double half = vtkMath::RadiansFromDegrees(0.5 * light.angle);
  const Rings rings(light.direction);
  const Vector centre = Along(light.position, length * std::cos(half), light.direction);
  const double radius = length * std::sin(half);
  for (int side = 0; side < Sides; ++side)
  {
    drawing.Line(rings.Place(centre, radius, side), rings.Place(centre, radius, side + 1));
    if (side % 2 == 0)
    {
      drawing.Line(light.position, rings.Place(centre, radius, side));
    }
  }
}

void Rectangle(Drawing& drawing, const Light& light)
{
  const auto [first, second] = RectangleEdges(light);
  const Vector middle = Along(light.position, -0.5, second);
  const Vector corner = Along(middle, -0.5, first);
  const Vector next = Along(middle, 0.5, first);
  drawing.Quad(corner, next, Along(next, 1.0, second), Along(corner, 1.0, second));
  Arrow(drawing, light.position, light.direction, Facing * std::max(light.size[0], light.size[1]));
}

void Draw(Drawing& drawing, const DrawnLight& drawn)
{
  const Light& light = drawn.light;
  drawing.SetColor(ColorOf(light));
  switch (light.type)
  {
    case LightType::Directional: Arrow(drawing, light.position, light.direction, drawn.length); break;
    case LightType::Point: Ball(drawing, light.position, drawn.length); break;
    case LightType::Spot: Cone(drawing, light, drawn.length); break;
    case LightType::Rectangle: Rectangle(drawing, light); break;
  }
}
}

void DrawLights(const std::vector<DrawnLight>& lights, vtkPolyData* shapes)
{
  Drawing drawing;
  for (const DrawnLight& drawn : lights)
  {
    Draw(drawing, drawn);
  }
  drawing.MoveInto(shapes);
}
}
