#include "tools/hovermodal/plan/options.h"

#include "drivers/host/command_line.h"

namespace tools {
namespace {

void add_structure(drivers::Command& command, PlanOptions& o) {
  const char* group = "Structure";
  command
      .option("--structure", o.structure,
              "Ideal shapes: shear (a frame of equal storeys), cantilever (a tower), beam (a bridge deck); or the "
              "structure file of closeloop, with regions: its shapes and, unless given, its frequencies")
      .show_default()
      .group(group);
  command.option("--storeys", o.storeys, "shear: number of storeys; a region on every floor").group(group);
  command.option("--storey-mm", o.storey_mm, "shear: height of a storey, mm (or --size-m for all)").group(group);
  command.option("--size-m", o.size_m, "Height or span, m").group(group);
  command.option("--regions", o.regions, "cantilever, beam: regions spread evenly over it (6)").group(group);
  command.option("--axis", o.axis, "Orientation of the structure in the image: vertical, horizontal (beam: horizontal)")
      .one_of({"vertical", "horizontal"})
      .group(group);
  command.option("--frequencies", o.frequency_hz, "Expected natural frequencies, Hz, ascending, with commas between")
      .separator(',')
      .type_name("HZ,...")
      .group(group);
  command.option("--damping-percent", o.damping_percent, "One for all, or one for each mode (1)")
      .separator(',')
      .type_name("PERCENT,...")
      .group(group);
  command
      .option("--amplitude-mm", o.amplitude_mm,
              "Expected rms where a mode moves most, mm: one for all, or one for each")
      .separator(',')
      .type_name("MM,...")
      .group(group);
  command
      .option("--shapes", o.shapes_file,
              "CSV in place of the ideal shapes: a line per region, columns position_mm and one for each mode")
      .type_name("FILE")
      .group(group);
}

void add_camera(drivers::Command& command, PlanOptions& o) {
  const char* group = "Camera";
  command.option("--distance-m", o.distance_m, "From the camera to the structure, m").required().group(group);
  command.option("--focal-px", o.focal_px, "Focal length in px, from a calibration; or").group(group);
  command.option("--focal-mm", o.focal_mm, "... in mm (the true one, not the equivalent), with").group(group);
  command.option("--sensor-width-mm", o.sensor_width_mm, "... the width of the sensor used for video; or").group(group);
  command.option("--fov-deg", o.fov_deg, "... the field of view across the width, degrees").group(group);
  command.option("--image", o.image, "2160p, 1080p, 720p, ... or WIDTHxHEIGHT, px").show_default().group(group);
  command.option("--fps", o.fps, "Frames per second").show_default().group(group);
  command.option("--rates", o.rates_hz, "Rates the camera can be set to (24 to 120, the usual ones)")
      .separator(',')
      .type_name("HZ,...")
      .group(group);
  command
      .option("--readout-ms", o.readout_ms,
              "Rolling shutter: first to last line, ms; 0 = global shutter. Half of all cameras need 15 or more")
      .show_default()
      .group(group);
  command
      .option("--readout-direction", o.direction,
              "Direction in which lines are read in the image, as the camera is held")
      .one_of({"down", "up", "left", "right"})
      .show_default()
      .group(group);
  command.option("--exposure-ms", o.exposure_ms, "Exposure time, ms; 0 = very short").show_default().group(group);
}

void add_tracking(drivers::Command& command, PlanOptions& o) {
  const char* group = "Points";
  command.option("--points", o.points, "Points per region").show_default().group(group);
  command
      .option("--texture", o.texture,
              "poor (painted wall, haze), ordinary (concrete, brick), good (targets, lattice): 3, 8, 16 grey/px")
      .one_of({"poor", "ordinary", "good"})
      .show_default()
      .group(group);
  command.option("--gradient", o.gradient_grey, "The same measured: rms gradient, grey levels per px").group(group);
  command.option("--noise-grey", o.noise_grey, "Noise of a pixel, grey levels rms").show_default().group(group);
  command.option("--window-px", o.window_px, "Side of the tracked patch, px").show_default().group(group);
  command
      .option("--point-sigma-px", o.point_sigma_px,
              "Noise of a point, px rms, in place of the four above (0.02 to 0.03 is ordinary)")
      .group(group);
  command.option("--region-mm", o.region_mm, "WIDTHxHEIGHT of a region, mm: limits how many points count")
      .type_name("WxH")
      .group(group);
}

void add_wishes(drivers::Command& command, PlanOptions& o) {
  const char* group = "Wanted";
  command.option("--sigma-f-percent", o.sigma_f_percent, "Standard deviation of every frequency, %")
      .show_default()
      .group(group);
  command.option("--sigma-zeta-percent", o.sigma_zeta_percent, "... of every damping ratio, % of it")
      .show_default()
      .group(group);
  command.option("--hover-min", o.hover_min, "Minutes to hover (as long as that needs)").group(group);
  command.option("--battery-min", o.battery_min, "Minutes on station that one battery gives").group(group);
  command.option("--out", o.folder, "Folder for plan.svg and plan.json").type_name("DIR").group(group);
  add_answer_options(command, o.answer, "plan.json");
}

}  // namespace

void add_plan_options(drivers::Command& command, PlanOptions& options) {
  add_structure(command, options);
  add_camera(command, options);
  add_tracking(command, options);
  add_wishes(command, options);
  command.footer(
      "Example, the laboratory frame of Yoon et al. 2017 (six storeys, filmed from 2 m by a 1080p drone camera):\n"
      "  hovermodal plan --storeys 6 --storey-mm 140 --frequencies 1.657,5.04,8.14,10.83,12.93,14.34 \\\n"
      "    --damping-percent 1 --distance-m 2 --focal-px 2100 --fps 25 --readout-ms 26 --exposure-ms 4 \\\n"
      "    --amplitude-mm 4,0.22,0.054,0.018,0.006,0.002 --battery-min 20 --out plan\n"
      "It says: modes 5 and 6 are above half of 25 fps and appear at 12.07 and 10.66 Hz; the delays between the rows\n"
      "tell that, but mode 6 then lies within the width of mode 4; 29.97 fps shows all six at their own places.\n"
      "\n"
      "A bridge deck of 40 m from 150 m, a lens of 24 mm on a sensor 13.2 mm wide; it says: rotate the camera:\n"
      "  hovermodal plan --structure beam --size-m 40 --frequencies 2.1,8.3,18.5 --distance-m 150 \\\n"
      "    --focal-mm 24 --sensor-width-mm 13.2 --image 2160p --fps 29.97 --rates 24,25,29.97 --readout-ms 20 "
      "--exposure-ms 2");
}

}  // namespace tools
