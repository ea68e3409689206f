#include "core/rotors/aircraft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using core::AircraftLog;
using core::AircraftState;
using core::AircraftSummary;

TEST(AircraftLog, KnowsNothingBeforeTheFirstState) {
  const AircraftLog log;
  EXPECT_TRUE(log.empty());
  EXPECT_TRUE(log.summary().empty());
  EXPECT_EQ(log.summary().n_states, 0U);
}

TEST(AircraftLog, SummarisesAFlight) {
  AircraftLog log;
  for (int k = 0; k < 100; ++k) {
    AircraftState state;
    state.motor_hz[0] = 95.0 + 0.1 * (k % 3 - 1);
    state.motor_hz[2] = k < 5 ? 20.0 : 97.0;  // starts up
    state.latitude_deg = 47.5 + 1e-6 * (k % 2), state.longitude_deg = 8.5;
    state.above_home_m = k % 2 == 0 ? 24.0 : 26.0;
    state.wind_m_s = 4.0, state.wind_from_deg = k % 2 == 0 ? 350.0 : 10.0;
    log.add(state);
  }
  const AircraftSummary flight = log.summary();
  EXPECT_EQ(flight.n_states, 100U);
  ASSERT_EQ(flight.motors.size(), 2U);
  EXPECT_EQ(flight.motors[0].number, 1);
  EXPECT_NEAR(flight.motors[0].hz, 95.0, 1e-4);
  EXPECT_NEAR(flight.motors[0].spread_hz, 0.148, 0.001);
  EXPECT_EQ(flight.motors[1].number, 3);
  EXPECT_NEAR(flight.motors[1].hz, 97.0, 1e-4);
  EXPECT_EQ(flight.motors[1].spread_hz, 0.0) << "the start counts little";
  ASSERT_TRUE(flight.place && flight.place->above_home_m);
  EXPECT_NEAR(flight.place->latitude_deg, 47.5 + 0.5e-6, 1e-12);
  EXPECT_NEAR(*flight.place->above_home_m, 25.0, 1e-12);
  ASSERT_TRUE(flight.wind);
  EXPECT_NEAR(flight.wind->m_s, 4.0 * std::cos(10.0 / 57.29577951308232), 1e-12);
  EXPECT_NEAR(std::remainder(flight.wind->from_deg, 360.0), 0.0, 1e-9) << "350 and 10 degrees are north together";
}

TEST(AircraftLog, APlaceOnTheDateLineIsOnTheDateLine) {
  AircraftLog log;
  for (const double longitude : {179.999, -179.999}) {
    AircraftState state;
    state.latitude_deg = -17.0, state.longitude_deg = longitude;
    log.add(state);
  }
  ASSERT_TRUE(log.summary().place);
  EXPECT_NEAR(std::abs(log.summary().place->longitude_deg), 180.0, 1e-9);
  EXPECT_FALSE(log.summary().place->above_home_m);
}

TEST(AircraftLog, WhatCannotBeIsLeftOut) {
  AircraftLog log;
  AircraftState state;
  state.motor_hz.fill(std::numeric_limits<double>::quiet_NaN());
  state.motor_hz[1] = 0.2, state.motor_hz[2] = 1e9, state.motor_hz[3] = -50.0;
  state.latitude_deg = 95.0, state.longitude_deg = 8.0;
  state.wind_m_s = std::numeric_limits<double>::infinity(), state.wind_from_deg = 10.0;
  log.add(state);
  EXPECT_TRUE(log.summary().empty());
}

TEST(AircraftLog, OfALongFlightTheNewestRatesCount) {
  AircraftLog log;
  for (int k = 0; k < 5000; ++k) {
    AircraftState state;
    state.motor_hz[0] = k < 2500 ? 80.0 : 90.0;
    log.add(state);
  }
  EXPECT_EQ(log.summary().n_states, 5000U);
  EXPECT_NEAR(log.summary().motors.at(0).hz, 90.0, 1e-4);
}

}  // namespace
