#include "tribound/certify/bound/components.h"

#include <cmath>

namespace tribound::certify
{

double BoundComponents::body() const
{
  return osc + stress() + neu + lin1 + reg1;
}

double BoundComponents::contact() const
{
  return std::hypot(cnt + lin2n + reg2n, frc + lin2t + reg2t);
}

double BoundComponents::total() const
{
  return std::hypot(osc + str + mor + neu + lin1 + reg1, cnt + frc + lin2n + lin2t + reg2n + reg2t);
}

double BoundComponents::total_sharp() const
{
  return std::hypot(body(), contact());
}

std::vector<Component> components_of_run(const RunKind& kind)
{
  std::vector<Component> components(plain_components.begin(), plain_components.end());
  const auto add = [&](std::span<const Component> others)
  { components.insert(components.end(), others.begin(), others.end()); };
  if (kind.regularised) add(regularisation_components);
  if (kind.paired) add(transfer_components);
  return components;
}

const char* to_string(BoundPart part)
{
  switch (part)
  {
    case BoundPart::body:
      return "body";
    case BoundPart::normal:
      return "normal";
    case BoundPart::tangential:
      return "tangential";
    case BoundPart::combined:
      return "combined";
    case BoundPart::whole:
      break;
  }
  return "whole";
}

const char* to_string(BoundCause cause)
{
  switch (cause)
  {
    case BoundCause::discretisation:
      return "discretisation";
    case BoundCause::linearisation:
      return "linearisation";
    case BoundCause::algebra:
      return "algebra";
    case BoundCause::regularisation:
      break;
  }
  return "regularisation";
}

}  // namespace tribound::certify
