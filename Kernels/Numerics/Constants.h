#pragma once

namespace tyndall
{
constexpr double Pi = 3.14159265358979323846;
}
