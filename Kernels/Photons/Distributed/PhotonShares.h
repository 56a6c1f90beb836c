#pragma once

#include "Photons/Marching/PhotonShares.h"
