#pragma once

#include "DiscreteOrdinates/DiscreteOrdinates.h"
#include "MediumScene.h"

/// A scene for discrete ordinates.
struct LitMedium : Scene
{
  tyndall::OrdinatesSettings how;

  using Scene::Scene;

  void ScatterWith(double g) { this->medium.phase = tyndall::PhaseFunction::HenyeyGreenstein(g); }

  tyndall::LightField SolveOrdinates(
    tyndall::Device& device, const tyndall::Monitor& monitor = {}, tyndall::KeptLight* kept = nullptr)
  {
    this->Attach();
    return tyndall::SolveDiscreteOrdinates(
      device, tyndall::Domain(this->medium.grid), this->medium, this->light, this->how, monitor, kept);
  }
};
