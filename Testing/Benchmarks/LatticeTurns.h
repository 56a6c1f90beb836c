#pragma once

#include "Device/Device.h"

/// Photons that march while their light diffuses: Table I of Bernabei et al., and what is gained over taking turns.
void PrintTurns(tyndall::Device& device, bool quick);
