#include "trial/assemble/prepare.h"

#include "core/base/error.h"
#include "models/setup/scene_sizes.h"

namespace enc::trial {

Scene prepare_setup(const models::Setup& setup) {
  try {
    return prepare(setup.scene, setup.rig);
  } catch (const Error& e) {
    throw Error(models::place_of(setup, e.key()) + ": " + e.what() + models::mesh_advice(setup, e.key()), {},
                e.kind());
  }
}

}  // namespace enc::trial
