#include "Medium/Over.h"
