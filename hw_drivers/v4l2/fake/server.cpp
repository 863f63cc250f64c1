#include "hw_drivers/v4l2/fake/server.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/base/error.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/v4l2/drive/settings.h"

namespace enc::v4l2 {

// ---- one device at its socket

Door::Door(const std::string& name, NodeSpec spec)
    : name_(name), node_(std::move(spec)), socket_(listen_at(name)) {
  if (socket_ >= 0) return;
  throw Error(fmt::format("{}: cannot listen there: {}; expected a free name; end the other fake, or change "
                          "`left` or `right` of [driver.v4l2]",
                          name, std::strerror(-socket_)),
              {}, ErrorKind::device);
}

Door::~Door() {
  plug(false);
  ::close(socket_);
}

void Door::wait_on(std::vector<int>& descriptors) const {
  descriptors.push_back(socket_);
  descriptors.insert(descriptors.end(), clients_.begin(), clients_.end());
}

void Door::let_in() {
  constexpr std::size_t kMostClients = 4;
  for (int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK); client >= 0;
       client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK)) {
    if (plugged_ && clients_.size() < kMostClients && send(client, Answer{}, node_.event()))
      clients_.push_back(client);
    else
      ::close(client);
  }
}

bool Door::answer(int client) {
  for (Call call; receive(client, call);) {
    Answer answer;
    if (call.kind == Call::Kind::map) {
      answer.result = node_.memory() < 0 ? -EINVAL : 0;
      if (!send(client, answer, node_.memory())) return false;
      continue;
    }
    answer.size = call.size;
    answer.data = call.data;
    answer.result = node_.control(client, call.request, std::span(answer.data).first(answer.size));
    if (!send(client, answer)) return false;
  }
  char byte = 0;
  const ssize_t left = ::recv(client, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return left > 0 || (left < 0 && errno == EAGAIN);
}

void Door::serve() {
  let_in();
  std::erase_if(clients_, [this](int client) {
    if (answer(client)) return false;
    node_.leave(client);
    ::close(client);
    return true;
  });
}

void Door::plug(bool in) {
  plugged_ = in;
  if (in) return;
  for (const int client : clients_) {
    node_.leave(client);
    ::close(client);
  }
  clients_.clear();
}

// ---- the cameras

namespace {

constexpr std::size_t kMostOnTheWay = 64;
constexpr int kUsualError = EIO;

NodeSpec node_of(const ServerSettings& settings, const char* side) {
  const bool two = !settings.right.empty();
  NodeSpec spec;
  spec.card = fmt::format("{} {}", kFakeName, two ? side : "stereo");
  spec.modes = {{settings.pixels, two ? settings.each.width : 2 * settings.each.width, settings.each.height,
                 settings.rate}};
  return spec;
}

}  // namespace

Server::Server(StereoCamera& camera, const ServerSettings& settings)
    : camera_(camera), settings_(settings), troubles_(settings.seed) {
  doors_.push_back(std::make_unique<Door>(settings.left, node_of(settings, "left")));
  if (!settings.right.empty())
    doors_.push_back(std::make_unique<Door>(settings.right, node_of(settings, "right")));
}

std::string Server::describe() const {
  return fmt::format("{} at {}{}{}, {} x {} px each at {:g} Hz, {}",
                     doors_.size() == 2 ? "two cameras" : "side-by-side camera", settings_.left,
                     doors_.size() == 2 ? " and " : "", settings_.right, settings_.each.width,
                     settings_.each.height, settings_.rate, word_of(settings_.pixels));
}

// In lockstep the client asks after the world has reached `now`, and even at the first tick, whose publish()
// came before the client.
void Server::serve(Time now) {
  if (settings_.lockstep) look(now);
  for (const auto& door : doors_) door->serve();
}

void Server::wait_on(std::vector<int>& descriptors) const {
  for (const auto& door : doors_) door->wait_on(descriptors);
}

// The last instant that is not later.
Duration Server::steady_at(Time t) const {
  if (settings_.lockstep) return t.time_since_epoch() + kLockstepZero;
  const auto after = std::upper_bound(instants_.begin(), instants_.end(), t,
                                      [](Time a, const auto& one) { return a < one.first; });
  if (after == instants_.begin()) return net::steady_now();
  const auto& [world, steady] = *std::prev(after);
  return steady + (t - world);
}

void Server::publish(Time now) {
  constexpr double kHistory = 2.0;                           // s: more than a picture takes to be drawn
  if (!instants_.empty() && now < instants_.back().first) {  // the world begins again
    instants_.clear();
    on_the_way_.clear();
    streams_since_.reset();
    troubles_.restart(settings_.seed);
  }
  instants_.emplace_back(now, net::steady_now());
  while (age(now, instants_.front().first) > kHistory) instants_.pop_front();
  if (!settings_.lockstep) look(now);
}

void Server::look(Time now) {
  const auto open =
      std::count_if(doors_.begin(), doors_.end(), [](auto& door) { return door->node().streams(); });
  // In lockstep the first frame waits for the second camera, or it would not be a pair.
  const bool streams = open >= (settings_.lockstep ? std::ssize(doors_) : 1);
  if (!streams) streams_since_.reset();
  if (streams && !streams_since_) streams_since_ = now;
  Measurement<StereoFrame> frame;
  if (streams && camera_.poll(now, frame) && frame.health == Health::ok) expose(now, frame);
  leave(now);
}

void Server::expose(Time now, const Measurement<StereoFrame>& frame) {
  using Kind = Trouble::Kind;
  if (troubles_.of(Kind::stall) || troubles_.of(Kind::disconnect)) return;
  if (const auto& slow = troubles_.of(Kind::slow_start); slow && age(now, *streams_since_) < *slow) return;
  const ImageView* right = &frame.value.right;
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const ImageView& first = i == 0 ? frame.value.left : frame.value.right;
    if (troubles_.happens(Kind::loss)) continue;
    Frame next{now, i, 0, steady_at(frame.t), {}};
    next.sequence =
        static_cast<std::uint32_t>(std::llround(seconds(frame.t.time_since_epoch()) * settings_.rate));
    next.bytes = encoder_.encode(settings_.pixels, first, doors_.size() == 1 ? right : nullptr);
    if (const auto& jitter = troubles_.of(Kind::jitter))
      next.due += from_seconds(*jitter * troubles_.uniform());
    if (troubles_.happens(Kind::half_message)) next.bytes.resize(next.bytes.size() / 2);
    if (troubles_.happens(Kind::garbage)) {
      for (std::uint8_t& byte : next.bytes) byte = troubles_.noise();
      next.damaged = true;
    }
    if (on_the_way_.size() == kMostOnTheWay) on_the_way_.pop_front();
    on_the_way_.push_back(std::move(next));
  }
}

// Frames of one device stay in order: a late one delays those after it.
void Server::leave(Time now) {
  while (!on_the_way_.empty() && on_the_way_.front().due <= now) {
    const Frame& frame = on_the_way_.front();
    static_cast<void>(
        doors_[frame.door]->node().put(frame.sequence, frame.stamp, frame.bytes, frame.damaged));
    on_the_way_.pop_front();
  }
}

bool Server::knows(const Trouble& trouble) const {
  using Kind = Trouble::Kind;
  if (trouble.kind == Kind::error_code) return !(trouble.value < 1.0 || trouble.value > 133.0);  // of errno
  return trouble.kind != Kind::reorder && trouble.kind != Kind::duplicate && trouble.kind != Kind::saturate;
}

void Server::suffer(const Trouble& trouble) {
  troubles_.suffer(trouble);
  for (const auto& door : doors_) {
    if (trouble.kind == Trouble::Kind::disconnect) door->plug(false);
    if (trouble.kind == Trouble::Kind::error_code)
      door->node().fail(std::isnan(trouble.value) ? kUsualError : static_cast<int>(trouble.value));
  }
}

void Server::heal(Trouble::Kind kind) {
  troubles_.heal(kind);
  for (const auto& door : doors_) {
    if (kind == Trouble::Kind::disconnect) door->plug(true);
    if (kind == Trouble::Kind::error_code) door->node().fail(0);
  }
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  V4l2Settings settings;
  settings.declare(offer.table);
  if (offer.camera == nullptr)
    throw Error("the scene names no [camera], whose pictures a fake camera sends; choose another scene");
  for (const std::string& name : {settings.left, settings.right})
    if (!name.empty() && !is_relayed(name))
      throw Error(fmt::format("[driver.v4l2] names '{}'; expected a name such as @encounter_camera, where a "
                              "fake can listen; see models/rigs",
                              name),
                  {}, ErrorKind::device);
  return std::make_unique<Server>(
      *offer.camera,
      ServerSettings{settings.left, settings.right, settings.pixels(), offer.spec.camera.size(),
                     offer.spec.camera.rate, offer.seed, static_cast<bool>(offer.advance)});
}

}  // namespace enc::v4l2
