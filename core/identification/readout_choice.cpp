#include "core/identification/readout_choice.h"

#include <cmath>
#include <string>

namespace core {

namespace {

constexpr double kAgree_sigmas = 4.0;
// Of a measured readout time: standard deviation of its error by a lens that is not declared (strong lenses: 1.4-2.2
// %).
constexpr double kUndeclaredLens = 0.01;

// A candidate value and its name in messages.
struct Named {
  ReadoutValue value;
  std::string name;
};

bool agree(const ReadoutValue& a, const ReadoutValue& b) noexcept {
  return std::abs(a.readout_s - b.readout_s) <= kAgree_sigmas * std::hypot(a.std_s, b.std_s);
}

// Whether the measured value leaves the declared one possible, an undeclared lens included.
bool allows(const ReadoutValue& measured, const ReadoutValue& declared) noexcept {
  return agree({measured.readout_s, std::hypot(measured.std_s, kUndeclaredLens * measured.readout_s)}, declared);
}

// Inverse-variance mean; an exact value is used alone.
Named combined(const Named& a, const Named& b) {
  if (!(a.value.std_s > 0.0)) return a;
  if (!(b.value.std_s > 0.0)) return b;
  const double wa = 1.0 / (a.value.std_s * a.value.std_s), wb = 1.0 / (b.value.std_s * b.value.std_s);
  return {{(wa * a.value.readout_s + wb * b.value.readout_s) / (wa + wb), 1.0 / std::sqrt(wa + wb)},
          a.name + " and " + b.name};
}

std::optional<ReadoutValue> sane(const std::optional<ReadoutValue>& value) {
  const bool known = value && std::isfinite(value->readout_s) && std::isfinite(value->std_s) && value->std_s > 0.0;
  return known ? value : std::nullopt;
}

// Combines a and b if they agree; otherwise keeps the more precise one.
void join(Named& a, const Named& b, ReadoutFinding& finding) {
  if (agree(a.value, b.value)) {
    a = combined(a, b);
    return;
  }
  finding.consistent = false;
  const bool a_stands = a.value.std_s <= b.value.std_s;
  const std::string contradicted = a_stands ? b.name : a.name;
  if (!a_stands) a = b;
  a.name += ", more precise than the value it contradicts: " + contradicted;
}

}  // namespace

ReadoutFinding choose_readout(const ReadoutValue& declared, const std::optional<ReadoutValue>& from_tracks,
                              const std::optional<ReadoutValue>& from_shapes) {
  ReadoutFinding finding;
  finding.declared = declared;
  finding.from_tracks = sane(from_tracks);
  finding.from_shapes = sane(from_shapes);
  std::optional<Named> measured;
  if (finding.from_tracks) measured = Named{*finding.from_tracks, "estimated from the tracks"};
  if (finding.from_shapes) {
    const Named shapes{*finding.from_shapes, "estimated from the modes' shapes"};
    if (measured) {
      join(*measured, shapes, finding);
    } else {
      measured = shapes;
    }
  }
  Named used{declared, "declared"};
  if (!measured) {
    used.name = "declared: neither tracks nor shapes determine the readout time";
  } else if (declared.std_s > 0.0 && !allows(measured->value, declared)) {
    finding.consistent = false;
    used = *measured;
    used.name += ", because it contradicts the declared value by more than four standard deviations";
  } else {
    join(used, *measured, finding);
  }
  finding.used = used.value;
  finding.why = used.name;
  return finding;
}

}  // namespace core
