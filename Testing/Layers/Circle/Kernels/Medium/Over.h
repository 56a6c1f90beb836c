#include "Device/Under.h"
