// The response file of the tennis ball until the rig has measured one: the plant formula, pressed and
// released as the rig does [VHMR Fig 7], fitted, and said to be synthetic.
#pragma once

#include <string>
#include <vector>

#include "core/loop_model.h"
#include "models/response_fit.h"
#include "sim/ball_plant.h"

namespace enc::bench {

// One press from rest to `limit` (m) and back at `speed` (m/s), read at 1 kHz, without noise or quantisation.
[[nodiscard]] std::vector<models::LoopPoint> plant_loop(const sim::BallParameters& ball, double speed,
                                                        double limit);

// The slope below which no fitted curve may fall, N/m. See the .cpp for the rule.
[[nodiscard]] double fit_floor(const LoopModel& loop);

// Text of models/responses/tennis_ball.toml; `encounter response` writes it.
[[nodiscard]] std::string plant_response_text(const sim::BallParameters& ball, double speed, double limit,
                                              const LoopModel& loop);

}  // namespace enc::bench
