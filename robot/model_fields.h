#pragma once

#include "robot/model.h"

namespace rubble::robot {

/// What a field of the robot model is called in logs and, with its unit, in the protocol of mapper processes.
struct ModelKey {
  const char* log;
  const char* protocol;     ///< null: mappers are not told
  bool is_younger = false;  ///< older logs do not have it
};

/// Walks over the fields of a robot model, field(key, value): one list for all who write or read one, so that they
/// cannot disagree.
template <class Model, class Field>
void each_model_field(Model& m, Field&& field) {
  field(ModelKey{"name", "robot.name"}, m.name);
  field(ModelKey{"length", "robot.length_m"}, m.length);
  field(ModelKey{"width", "robot.width_m"}, m.width);
  field(ModelKey{"wheel_radius", "robot.wheel_radius_m"}, m.wheel_radius);
  field(ModelKey{"wheelbase", "robot.wheelbase_m"}, m.wheelbase);
  field(ModelKey{"track", "robot.track_m"}, m.track);
  field(ModelKey{"effective_track", "robot.effective_track_m"}, m.effective_track);
  field(ModelKey{"ground_clearance", "robot.ground_clearance_m"}, m.ground_clearance);
  field(ModelKey{"climbable_step", "robot.climbable_step_m"}, m.climbable_step);
  field(ModelKey{"mass", "robot.mass_kg"}, m.mass);
  field(ModelKey{"max_v", "robot.max_v_m_s"}, m.max_v);
  field(ModelKey{"max_w", "robot.max_w_rad_s"}, m.max_w);
  field(ModelKey{"max_accel", "robot.max_accel_m_s2"}, m.max_accel);
  field(ModelKey{"max_turn_accel", "robot.max_turn_accel_rad_s2"}, m.max_turn_accel);
  field(ModelKey{"command_timeout", "robot.command_timeout_s"}, m.command_timeout);
  field(ModelKey{"odometry_period", "robot.odometry_period_s"}, m.odometry_period);
  field(ModelKey{"acceleration_period", "robot.acceleration_period_s"}, m.acceleration_period);
  field(ModelKey{"tick", "robot.tick_s"}, m.tick);
  field(ModelKey{"has_levelling_unit", "robot.has_levelling_unit"}, m.has_levelling_unit);
  field(ModelKey{"max_aim", "robot.max_aim_rad"}, m.max_aim);
  field(ModelKey{"accelerometer_mount", "robot.accelerometer_on_body", true}, m.accelerometer_mount);
  field(ModelKey{"laser_name", "laser.name"}, m.laser.name);
  field(ModelKey{"base_laser_x", "laser.x_m"}, m.T_base_laser.x);
  field(ModelKey{"base_laser_y", "laser.y_m"}, m.T_base_laser.y);
  field(ModelKey{"base_laser_z", "laser.z_m"}, m.T_base_laser.z);
  field(ModelKey{"base_laser_yaw", "laser.yaw_rad"}, m.T_base_laser.yaw);
  field(ModelKey{"base_laser_pitch", "laser.pitch_rad"}, m.T_base_laser.pitch);
  field(ModelKey{"base_laser_roll", "laser.roll_rad"}, m.T_base_laser.roll);
  field(ModelKey{"laser_beams", "laser.beams"}, m.laser.beams);
  field(ModelKey{"laser_angle_min", "laser.angle_min_rad"}, m.laser.angle_min);
  field(ModelKey{"laser_angle_step", "laser.angle_step_rad"}, m.laser.angle_step);
  field(ModelKey{"laser_range_min", "laser.range_min_m"}, m.laser.range_min);
  field(ModelKey{"laser_range_max", "laser.range_max_m"}, m.laser.range_max);
  field(ModelKey{"laser_scan_period", "laser.scan_period_s"}, m.laser.scan_period);
  field(ModelKey{"laser_beam_period", "laser.beam_period_s"}, m.laser.beam_period);
  field(ModelKey{"laser_accuracy_near", nullptr, true}, m.laser.accuracy_near);
  field(ModelKey{"laser_accuracy_near_to", nullptr, true}, m.laser.accuracy_near_to);
  field(ModelKey{"laser_accuracy_far", nullptr, true}, m.laser.accuracy_far);
  field(ModelKey{"laser_accuracy_far_share", nullptr, true}, m.laser.accuracy_far_share);
  field(ModelKey{"laser_has_codes", nullptr, true}, m.laser.has_codes);
}

}  // namespace rubble::robot
