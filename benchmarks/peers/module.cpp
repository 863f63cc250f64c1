// The module's entry. CMake chose its peers when it was built (CMakeLists.txt).
#include "core/devices/module.h"

#include "benchmarks/peers/peers.h"

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::bench::PeersModule kPeers{
#ifdef ENCOUNTER_EMBREE
      .embree = enc::bench::make_embree,
#endif
#ifdef ENCOUNTER_KDL
      .kdl = enc::bench::make_kdl,
#endif
#ifdef ENCOUNTER_OPENCV
      .opencv = &enc::bench::kOpenCv,
#endif
  };
  static const enc::ModuleInfo kInfo{.name = "peers", .peers = &kPeers};
  return &kInfo;
}
