// Seeds in text formats.
#include "drivers/storage/scene/scene_file.h"
#include "drivers/storage/text_file.h"
#include "tests/fuzz/make_corpus.h"

namespace tests::fuzz {
namespace {

void write_config() {
  keep("config", "example", drivers::read_text_file("firmware_app/config/example.yaml", 1U << 20U));
  keep("config", "synthetic", drivers::read_text_file("firmware_app/config/synthetic.yaml", 1U << 20U));
  const std::string small = "camera: {driver: file, source: a.mp4}\nregions:\n  - {name: roof, rect: [1, 2, 30, 40]}\n";
  keep("config", "small", small);
  keep("config", "overrides",
       small + std::string("\0camera.rate_hz=25\0regions.0.rect=[5, 6, 70, 80]\0spectrum={segment: 64}", 72));
  keep("config", "lengths",
       small + "scale: {lengths: [[1, 2, 3, 40, 500], [1, 2, 30, 4, 250.5]]}\ntelemetry: {lcm_url: \"\"}\n");
  keep("config", "unknown_key", small + "spectrum: {segmnt: 64}\n");
  keep("config", "text_for_number", "# first\ncamera: {source: 'a # b', rate_hz: fast}\nregions: []\n");
}

void write_calibration() {
  keep("calibration", "kalibr",
       "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.29, 0.08, -0.0003, 0.0001]\n"
       "  distortion_model: radtan\n  intrinsics: [461.6, 460.1, 362.6, 246.0]\n  resolution: [752, 480]\n");
  keep("calibration", "opencv",
       "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n"
       "   dt: d\n   data: [ 650., 0., 320., 0., 660., 240., 0., 0., 1. ]\n"
       "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
       "   data: [ -0.4, 0.2, 0., 0., -0.05 ]\navg_reprojection_error: 0.2\n");
  keep("calibration", "ros",
       "height: 480\nwidth: 640\ndistortion_model: equidistant\nD: [-0.01, 0.02, -0.003, 0.0004]\n"
       "K: [350.5, 0.0, 320.0, 0.0, 351.5, 240.0, 0.0, 0.0, 1.0]\n");
  keep("calibration", "rational",
       "height: 480\nwidth: 640\ndistortion_model: rational_polynomial\n"
       "D: [0.1, 0.01, 0.001, 0.001, 0.001, 0.1, 0.01, 0.001]\n"
       "K: [350.5, 0.0, 320.0, 0.0, 351.5, 240.0, 0.0, 0.0, 1.0]\n");
  keep("calibration", "omni", "cam0:\n  camera_model: omni\n  intrinsics: [0.8, 461.6, 460.1, 362.6, 246.0]\n");
}

void write_scene() {
  keep("scene", "deck", drivers::scene_text(drivers::preset_scene({"deck", {}, {}, {}, {}})));
  keep("scene", "readout", "preset: paper\nduration_s: 60\ncamera: {readout_ms: 30}\ndeclare: {readout_ms: false}\n");
  keep("scene", "modes",
       "preset: paper\nstructure:\n  type: modes\n  frequency_hz: [1.5, 4.5]\n  shapes: [[0.5, 1], [1, -0.5]]\n");
  keep("scene", "flight", "flight: {file: no/such/log.csv, from_s: 3, to_s: 9}\n");
  keep("scene", "frame",
       "structure:\n  kind: shear_frame\n  storeys: 3\n  storey_height_mm: 140\n  masses: [1, 1, 0.8]\n"
       "  stiffness_ratio: [2, 1, 1]\n  data: simulated\n  dt_s: 0.01\n  floors: [a, b, c]\n");
}

void write_matrices() {
  keep("matrix_market", "symmetric",
       "%%MatrixMarket matrix coordinate real symmetric\n% two masses\n2 2 3\n1 1 3.0e6\n2 1 -1e6\n2 2 1e6\n");
  keep("matrix_market", "array", "%%MatrixMarket matrix array real general\n2 2\n3\n-1\n-1\n1\n");
  keep("matrix_market", "integer", "%%MatrixMarket matrix coordinate integer general\r\n3 3 2\r\n1 1 2\r\n3 3 5\r\n");
  keep("matrix_market", "too_many", "%%MatrixMarket matrix coordinate real general\n2 2 99999999999\n1 1 1\n");
  keep("matrix_market", "outside", "%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1\n");
  keep("matrix_market", "complex", "%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1 0\n");
}

void write_tables() {
  keep("timestamps", "plain", "frame,t_s\n0,4.438000\n1,4.495000\n2,4.5525\n");
  keep("timestamps", "comments",
       "\xEF\xBB\xBF"
       "# made by hand\r\nframe , t_s\r\n\r\n0,-1e-9\r\n# pause\r\n1,8.9e9\r\n");
  keep("timestamps", "backward", "frame,t_s\n0,1\n1,0.5\n");
  keep("clip_telemetry", "srt_frames",
       "s1\n00:00:00,000 --> 00:00:00,033\n<font size=\"36\">SrtCnt : 1, DiffTime : 33ms\n2022-08-07 13:40:40,774,808\n"
       "[iso : 100] [shutter : 1/80.0] [focal_len : 240] [dzoom_ratio: 10000, delta:0]\n\n2\n2022-08-07 13:40:40.808\n"
       "[gb_yaw: 1 gb_pitch: -2 gb_roll: 0.5]\n");
  keep("clip_telemetry", "srt_seconds",
       "s1\r\n00:00:01,000 --> 00:00:02,000\r\nHOME(149.0251,-20.2532) 2017.8.5 14:11:51\r\nISO:100 TV:60 EV: 0\r\n\r\n"
       "2\r\nF/5.6, SS 400, G.PRY (-27.3\xC2\xB0, 0.0\xC2\xB0, -76.0\xC2\xB0)\r\n");
  using namespace std::string_literals;
  keep("clip_telemetry", "gpmf",
       "gDEVC\0\1\0\x50"
       "DVNMc\1\0\4Cam1"
       "STRM\0\1\0\x3C"
       "STMPJ\x08\0\1\0\0\0\0\0\1\0\0"
       "ORINc\1\0\3XzY\0"
       "SCALs\2\0\1\1\0\0\0"
       "GYROs\6\0\2\0\1\0\2\0\3\0\4\0\5\0\6"s);
  keep("series", "series", "s# unit: mm\nframe,t_s,a,\"b\"\n0,0.1,1.5,\n1,0.14,nan,2e-3\n");
  keep("series", "one_column", "sa\n1\n\n3\n");
  keep("series", "semicolons", "fZeit [s];ax [m/s^2]\n0,00;1,5\n0,01;-2,5e-3\n0,02;inf\n");
  keep("series", "labview",
       "fLabVIEW Measurement\t\nSeparator\tTab\nDelta_X\t0.01\t\n***End_of_Header***\t\nX_Value\tA "
       "(g)\n0\t1.5\n0.01\t2\n");
  keep("series", "no_names", "n% a comment\n1 2 3\n4 5 NaN\n7 8 9\n");
  keep("series", "tracks",
       "t# image_size_px: 640 x 480\n# rate_hz: 25\n# readout_ms: -10\n# readout_direction: up\n# regions: a,b\n"
       "frame,t_s,point,region,u_px,v_px,sigma_px\n0,0.0,1,a,10.5,20.5,0.05\n0,0.0,2,b,1,2,0\n3,0.123456789,1,a,11,21,"
       "0.1\n");
  keep("series", "attitude_angles",
       "at_ms,roll_deg,pitch_deg,yaw_deg,more\n0,1,2,3,x\n# gap\n10,1.5,2,179,y\n20,1,2,-179,z\n");
  keep("series", "attitude_quaternions", "at_s,qw,qx,qy,qz\n0,1,0,0,0\n0.01,0.7,0.7,0,0.1\n");
  std::string columns = "c\"Time (s)\",a (deg),b\n";
  for (int k = 0; k <= 40; ++k) columns += std::to_string(0.25 * k) + "," + std::to_string(350 + k % 20) + ",\"1\"\n";
  keep("series", "columns", columns);
}

}  // namespace

void write_texts() {
  write_config();
  write_calibration();
  write_scene();
  write_matrices();
  write_tables();
}

}  // namespace tests::fuzz
