#include "TestSupport.h"

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkSeparablePhaseFunction.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include "Numerics/Constants.h"

#include <cmath>

namespace
{
using tyndall::Pi;

double Value(vtkTable* table, int row, const char* column)
{
  return table->GetValueByName(row, column).ToDouble();
}

void HasOrthonormalFactors(test::Claims& claims)
{
  vtkNew<vtkSeparablePhaseFunction> phase;
  test::Errors errors(phase);
  phase->SetTerms(9);
  phase->Update();
  claims.That(errors.None(), "made without complaint");
  vtkTable* factors = phase->GetOutput(0);
  claims.That(factors->GetNumberOfRows() == 128 && factors->GetNumberOfColumns() == 11, "a row a direction");
  double weights = 0.0, ones = 0.0, mixed = 0.0;
  for (int d = 0; d < 128; ++d)
  {
    const double weight = Value(factors, d, "weight"), second = Value(factors, d, "u_2");
    weights += weight;
    ones += weight * second * second;
    mixed += weight * second * Value(factors, d, "u_5");
  }
  claims.Near(weights, 4.0 * Pi, 1e-10, "weights add up");
  claims.Near(ones, 1.0, 1e-10, "a factor's norm");
  claims.Near(mixed, 0.0, 1e-10, "two factors' product");
}

void HasTheErrorsOfThePaper(test::Claims& claims)
{
  vtkNew<vtkSeparablePhaseFunction> phase;
  phase->SetDirectionSet(vtkSeparablePhaseFunction::PUBLISHED_SPIRAL);
  phase->RepairedOff();
  phase->Update();
  vtkTable* errors = phase->GetOutput(1);
  claims.That(errors->GetNumberOfRows() == 24, "a row for each number of terms");
  claims.That(std::string(phase->GetLeftOut()).empty(), "all terms are needed");
  claims.Near(Value(errors, 23, "error"), 0.0929, 1e-4, "24 terms at g = 0.5: about a tenth");
  claims.Near(Value(errors, 23, "error_theory"), 0.0927, 1e-4, "and in theory");
  claims.Near(Value(errors, 3, "eigenvalue"), 0.5, 0.01, "the fourth eigenvalue is g");
  claims.Near(Value(errors, 23, "error_singular_values"), Value(errors, 23, "error"), 0.0, "of the kind asked for");
  claims.That(Value(errors, 23, "error_spherical_harmonics") >= Value(errors, 23, "error"), "none is better");
  phase->RepairedOn();
  phase->SetDirectionSet(vtkSeparablePhaseFunction::CUBE);
  phase->Update();
  claims.Near(Value(phase->GetOutput(1), 23, "row_sum_error"), 0.0, 1e-10, "repaired, it scatters all power");
  claims.Near(Value(phase->GetOutput(1), 23, "mean_cosine_error"), 0.0, 1e-10, "with its mean cosine");
}

void SaysWhatIsWrong(test::Claims& claims)
{
  vtkNew<vtkSeparablePhaseFunction> phase;
  test::Errors errors(phase);
  phase->SetTerms(200);
  phase->Update();
  claims.That(errors.WasOneWith("200 terms"), "more terms than directions");
  claims.That(phase->GetOutput(0)->GetNumberOfRows() == 0, "nothing is made");
  phase->SetPhaseFunction(vtkSeparablePhaseFunction::RAYLEIGH);
  phase->SetTerms(24);
  phase->Update();
  claims.That(errors.None(), "works again after that");
  phase->SetFactorisation(vtkSeparablePhaseFunction::SPHERICAL_HARMONICS);
  phase->Update();
  claims.That(phase->GetOutput(0)->GetNumberOfColumns() == 2 + 6, "Rayleigh's has six terms");
  claims.That(std::isnan(Value(phase->GetOutput(1), 6, "eigenvalue")), "and no seventh");
  claims.That(std::string(phase->GetLeftOut()).find("terms 7 to 24") != std::string::npos, "which is told");
}
}

int TestSeparablePhaseFunction(int, char*[])
{
  test::Claims claims;
  HasOrthonormalFactors(claims);
  HasTheErrorsOfThePaper(claims);
  SaysWhatIsWrong(claims);
  return claims.Result();
}
