#include "tools/hovermodal/regions/regions_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/types/role_names.h"
#include "drivers/storage/json.h"

namespace tools {
namespace {

using core::ProposedRegion;

constexpr double kBelow = 1.5;  // heights of the lowest region
constexpr double kLess = 0.8;   // motion of another part, as a share of the lowest one's

std::string table_line(const std::string& rank, const ProposedRegion& one) {
  const core::Region& r = one.region;
  return fmt::format("{:>4}  {:<8} {:>5} {:>5} {:>5} {:>5}  {:<10} {:>4} {:>7} {:>10.3f} {:>9.4f} {:>7}\n", rank,
                     r.name, r.u_px, r.v_px, r.width_px, r.height_px, core::to_string(r.role), axis_text(r),
                     one.n_points, one.motion_px, one.noise_px,
                     one.shared > 0.0 ? fmt::format("{:.2f}", one.shared) : std::string("-"));
}

}  // namespace

std::string axis_text(const core::Region& region) {
  if (region.both_axes) return "both";
  const double degrees = region.axis_deg;
  return degrees == 0.0 ? "u" : degrees == 90.0 || degrees == -90.0 ? "v" : fmt::format("{:g}", degrees);
}

std::vector<core::Region> in_order(const core::RegionProposal& proposal) {
  std::vector<core::Region> out;
  for (const ProposedRegion& one : proposal.regions) out.push_back(one.region);
  const bool upright = core::is_upright(proposal.regions);
  std::sort(out.begin(), out.end(),
            [&](const core::Region& a, const core::Region& b) { return upright ? a.v_px > b.v_px : a.u_px < b.u_px; });
  if (proposal.rest) out.push_back(proposal.rest->region);
  return out;
}

std::string make_lowest_base(core::RegionProposal& proposal) {
  if (proposal.regions.size() < 2 || !core::is_upright(proposal.regions))
    return "the parts do not stand one above the other";
  auto& lowest =
      *std::max_element(proposal.regions.begin(), proposal.regions.end(),
                        [](const ProposedRegion& a, const ProposedRegion& b) { return a.region.v_px < b.region.v_px; });
  const double bottom_px = lowest.region.v_px + lowest.region.height_px;
  if (proposal.lowest_moving_v_px > bottom_px + kBelow * lowest.region.height_px) {
    return fmt::format("points below {}, down to v = {:.0f}, move as well: it is not the lowest part",
                       lowest.region.name, proposal.lowest_moving_v_px);
  }
  for (const ProposedRegion& other : proposal.regions) {
    if (other.motion_px >= kLess * lowest.motion_px) continue;
    return fmt::format("{} moves less than {}, the lowest ({:.3g} against {:.3g} px): a base moves the least",
                       other.region.name, lowest.region.name, other.motion_px, lowest.motion_px);
  }
  lowest.region.role = core::RegionRole::kBase;
  lowest.region.name = "base";
  return {};
}

std::string regions_table(const core::RegionProposal& proposal) {
  std::string out = "rank  name         u     v width height  role       axis  points  motion px  noise px  shared\n";
  for (std::size_t i = 0; i < proposal.regions.size(); ++i)
    out += table_line(std::to_string(i + 1), proposal.regions[i]);
  if (proposal.rest) out += table_line("-", *proposal.rest);
  return out;
}

std::string proposal_json(const core::RegionProposal& proposal, int width_px, int height_px) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const auto add = [&](const ProposedRegion& one) {
    const core::Region& r = one.region;
    list.push_back({{"name", r.name},
                    {"rect", {r.u_px, r.v_px, r.width_px, r.height_px}},
                    {"role", core::to_string(r.role)},
                    {"axis", axis_text(r)},
                    {"points", one.n_points},
                    {"motion_px", one.motion_px},
                    {"noise_px", one.noise_px},
                    {"shared", one.shared > 0.0 ? nlohmann::ordered_json(one.shared) : nullptr}});
  };
  for (const ProposedRegion& one : proposal.regions) add(one);
  if (proposal.rest) add(*proposal.rest);
  return drivers::to_json_text(
             {{"version", 1}, {"size", {width_px, height_px}}, {"regions", list}, {"remark", proposal.remark}})
      .text;
}

std::string regions_yaml(const std::vector<core::Region>& regions) {
  std::string out =
      "# By `hovermodal regions`: check the picture, delete regions that do not belong. role: base "
      "for a part that moves\n# with the ground.\nregions:\n";
  if (regions.empty()) out.replace(out.size() - 1, 1, " []  # none was found\n");
  for (const core::Region& r : regions) {
    out += fmt::format("  - {{name: {}, rect: [{}, {}, {}, {}], role: {}, axis: {}}}\n", r.name, r.u_px, r.v_px,
                       r.width_px, r.height_px, core::to_string(r.role), axis_text(r));
  }
  return out;
}

}  // namespace tools
