#ifndef LastLight_h
#define LastLight_h

#include "Light/KeptLight.h"

#include <memory>

namespace tyndall
{
/// The light that a filter keeps from one update to the next, where its WarmStart is on.
class LastLight
{
public:
  /// To hand to a solver. Null, and what was kept is dropped, where it is not to be kept.
  KeptLight* Where(bool warmStart)
  {
    if (!warmStart)
    {
      this->Kept.reset();
    }
    else if (!this->Kept)
    {
      this->Kept = std::make_unique<KeptLight>();
    }
    return this->Kept.get();
  }

private:
  std::unique_ptr<KeptLight> Kept;
};
}

#endif
