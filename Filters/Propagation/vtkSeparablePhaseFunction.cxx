#include "vtkSeparablePhaseFunction.h"

#include "Common/LightTransportWriting.h"
#include "Common/PrintMembers.h"
#include "Light/LeftOut.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "PhaseFunction/SeparablePhaseFunction.h"
#include "Pieces/GuardedWork.h"

#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace
{
constexpr int MomentsDegree = 300; ///< highest Legendre degree used for `error_theory`

tyndall::PhaseFunction FunctionOf(vtkSeparablePhaseFunction* filter)
{
  switch (filter->GetPhaseFunction())
  {
    case vtkSeparablePhaseFunction::DOUBLE_HENYEY_GREENSTEIN:
      return tyndall::PhaseFunction::DoubleHenyeyGreenstein(
        filter->GetG(), filter->GetSecondG(), filter->GetFirstPart());
    case vtkSeparablePhaseFunction::SCHLICK: return tyndall::PhaseFunction::Schlick(filter->GetG());
    case vtkSeparablePhaseFunction::RAYLEIGH: return tyndall::PhaseFunction::Rayleigh();
    default: return tyndall::PhaseFunction::HenyeyGreenstein(filter->GetG());
  }
}

std::vector<tyndall::Direction> DirectionsOf(vtkSeparablePhaseFunction* filter)
{
  switch (filter->GetDirectionSet())
  {
    case vtkSeparablePhaseFunction::CUBE:
      return tyndall::EquiangularDirections(filter->GetDirectionsPerFace()).directions;
    case vtkSeparablePhaseFunction::SPIRAL: return tyndall::WeightedSpiralDirections(filter->GetSpiralDirections());
    default: return tyndall::SpiralDirections(filter->GetSpiralDirections());
  }
}

/// Adds a column of doubles to a table: value(row) in each of `rows` rows.
void AddColumn(vtkTable* table, const std::string& name, int rows, const std::function<double(int row)>& value)
{
  vtkNew<vtkDoubleArray> column;
  column->SetName(name.c_str());
  column->SetNumberOfValues(rows);
  for (int row = 0; row < rows; ++row)
  {
    column->SetValue(row, value(row));
  }
  table->AddColumn(column);
}

void WriteFactors(const tyndall::SeparablePhaseFunction& phase, vtkTable* table)
{
  vtkNew<vtkDoubleArray> directions;
  directions->SetName("direction");
  directions->SetNumberOfComponents(3);
  for (const tyndall::Direction& direction : phase.TheDirections())
  {
    directions->InsertNextTuple(direction.omega.data());
  }
  table->AddColumn(directions);
  const int count = phase.DirectionCount();
  AddColumn(table, "weight", count, [&](int d) { return phase.TheDirections()[d].weight; });
  for (int k = 0; k < phase.Terms(); ++k)
  {
    AddColumn(table, "u_" + std::to_string(k + 1), count, [&](int d) { return phase.Factor(d, k); });
  }
}

/// Writes output 1: eigenvalues and errors by the number of terms, 1 to `terms`.
/// @param phase  the phase function, factorised as Factorisation selects
/// @param other  the same phase function with the other factorisation
/// @param bySingularValues  whether `phase` is factorised by singular values
/// @param moments  Legendre moments of the phase function
void WriteErrors(const tyndall::SeparablePhaseFunction& phase, const tyndall::SeparablePhaseFunction& other,
  bool bySingularValues, const std::vector<double>& moments, int terms, vtkTable* table)
{
  using Errors = std::vector<tyndall::SeparableErrors>;
  const Errors errors = phase.ErrorsByTerms(), others = other.ErrorsByTerms();
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto add = [&](const char* name, const Errors& of, double tyndall::SeparableErrors::*number) {
    AddColumn(table, name, terms, [&](int k) { return k < static_cast<int>(of.size()) ? of[k].*number : unknown; });
  };
  vtkNew<vtkIntArray> counts;
  counts->SetName("terms");
  for (int k = 0; k < terms; ++k)
  {
    counts->InsertNextValue(k + 1);
  }
  table->AddColumn(counts);
  AddColumn(table, "eigenvalue", terms, [&](int k) { return k < phase.Terms() ? phase.Eigenvalue(k) : unknown; });
  AddColumn(table, "singular_value", terms,
    [&](int k) { return k < static_cast<int>(phase.SingularValues().size()) ? phase.SingularValues()[k] : unknown; });
  add("error", errors, &tyndall::SeparableErrors::frobenius);
  add("error_singular_values", bySingularValues ? errors : others, &tyndall::SeparableErrors::frobenius);
  add("error_spherical_harmonics", bySingularValues ? others : errors, &tyndall::SeparableErrors::frobenius);
  AddColumn(table, "error_theory", terms, [&](int k) { return tyndall::TheoreticalError(moments, k + 1); });
  add("error_max", errors, &tyndall::SeparableErrors::maximum);
  add("row_sum_error", errors, &tyndall::SeparableErrors::rowSum);
  add("mean_cosine_error", errors, &tyndall::SeparableErrors::meanCosine);
  add("least_value", errors, &tyndall::SeparableErrors::least);
}
}

vtkStandardNewMacro(vtkSeparablePhaseFunction);

vtkSeparablePhaseFunction::vtkSeparablePhaseFunction()
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkSeparablePhaseFunction::~vtkSeparablePhaseFunction() = default;

int vtkSeparablePhaseFunction::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return tyndall::Guarded(this, outputs, [&] {
    const tyndall::PhaseFunction function = FunctionOf(this);
    const std::vector<tyndall::Direction> directions = DirectionsOf(this);
    tyndall::SeparableSettings settings;
    settings.terms = this->Terms;
    settings.sampling = static_cast<tyndall::PhaseSampling>(this->Sampling);
    settings.repaired = this->Repaired;
    const bool bySingularValues = this->Factorisation == SINGULAR_VALUES;
    const auto made = [&](bool singularValues) {
      settings.factorisation =
        singularValues ? tyndall::PhaseFactorisation::SingularValues : tyndall::PhaseFactorisation::SphericalHarmonics;
      return tyndall::SeparablePhaseFunction(function, directions, settings);
    };
    const tyndall::SeparablePhaseFunction phase = made(bySingularValues), other = made(!bySingularValues);
    WriteFactors(phase, vtkTable::GetData(outputs, 0));
    WriteErrors(
      phase, other, bySingularValues, function.Moments(MomentsDegree), this->Terms, vtkTable::GetData(outputs, 1));
    std::vector<std::string> leftOut;
    if (phase.Terms() < this->Terms)
    {
      leftOut.push_back(tyndall::left_out::TermsOfZero(phase.Terms(), this->Terms));
    }
    for (int port = 0; port < 2; ++port)
    {
      tyndall::TellLeftOut(this, vtkTable::GetData(outputs, port), leftOut);
    }
  });
}

void vtkSeparablePhaseFunction::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PhaseFunction, G, SecondG, FirstPart, DirectionSet, DirectionsPerFace, SpiralDirections, Terms,
    Factorisation, Sampling, Repaired);
  tyndall::PrintRun(os, indent, this);
}
