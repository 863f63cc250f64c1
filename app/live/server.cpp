// A Foxglove WebSocket server on libwebsockets.
#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <libwebsockets.h>
#include <nlohmann/json.hpp>

#include "app/live/live_module.h"
#include "core/base/error.h"
#include "core/devices/module.h"

namespace enc::app {
namespace {

using Json = nlohmann::json;

constexpr const char* kProtocol = "foxglove.websocket.v1";
constexpr std::size_t kMostWaiting = std::size_t{8} << 20U;     // bytes for a client that does not take them
constexpr std::size_t kLongestRequest = std::size_t{1} << 16U;  // bytes

// The number of a channel or subscription. Throws Error.
std::uint32_t number_of(const Json& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw Error("expected a whole number of 32 bits, not " + json.dump(-1, ' ', true).substr(0, 100));
  return json.get<std::uint32_t>();
}

// Bytes for a client, behind the room that libwebsockets wants in front.
struct Packet {
  std::string bytes;
  lws_write_protocol kind;
  [[nodiscard]] std::size_t size() const { return bytes.size() - LWS_PRE; }
};

struct LiveClient {
  std::deque<Packet> waiting;
  std::size_t waiting_bytes = 0;
  std::map<std::uint32_t, std::uint16_t> channels;  // by the client's subscription
  std::string request;                              // received so far
};

// The newest message of a channel.
struct Newest {
  std::uint64_t time = 0;  // ns
  std::string data;        // empty: none yet
};

class Server final : public LiveServer {
 public:
  Server(const std::string& address, std::uint16_t port, const std::string& name) : name_(name) {
    lws_set_log_level(0, nullptr);
    lws_context_creation_info info{};
    info.port = port;
    info.iface = address.c_str();
    info.protocols = protocols_.data();
    info.gid = info.uid = static_cast<decltype(info.gid)>(-1);
    info.user = this;
    info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND |
                   LWS_SERVER_OPTION_DISABLE_IPV6;
    context_ = lws_create_context(&info);
    vhost_ = context_ == nullptr ? nullptr : lws_create_vhost(context_, &info);
    if (vhost_ == nullptr) {
      lws_context_destroy(context_);
      throw Error(
          fmt::format("{}:{}: cannot listen there; expected an address of this computer and a free "
                      "port; choose others",
                      address, port));
    }
  }
  ~Server() override { lws_context_destroy(context_); }

  [[nodiscard]] std::uint16_t port() const override {
    return static_cast<std::uint16_t>(lws_get_vhost_listen_port(vhost_));
  }
  void serve() override { lws_service(context_, -1); }
  [[nodiscard]] std::uint64_t dropped() const override { return dropped_; }

  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data) override {
    schemas_.push_back({{"schemaName", name}, {"schemaEncoding", encoding}, {"schema", data}});
    return static_cast<std::uint16_t>(schemas_.size());
  }
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema,
                            std::string_view message_encoding) override {
    Json channel = schemas_.at(schema - 1U);
    channel["id"] = channels_.size();
    channel["topic"] = topic;
    channel["encoding"] = message_encoding;
    channels_.push_back(std::move(channel));
    newest_.emplace_back();
    return static_cast<std::uint16_t>(channels_.size() - 1);
  }
  void message(std::uint16_t channel, std::uint64_t log_time, std::uint64_t, std::string_view data) override {
    newest_[channel] = {log_time, std::string(data)};
    for (auto& [link, client] : clients_)
      for (const auto& [subscription, of] : client.channels)
        if (of == channel) send(link, client, message_bytes(subscription, log_time, data), LWS_WRITE_BINARY);
  }
  void attach(std::string_view, std::string_view, std::string_view) override {}
  void metadata(std::string_view, const std::map<std::string, std::string>&) override {}
  // Sends what clients still take, for a moment. The rest counts as dropped.
  void close() override {
    constexpr int kTurns = 10'000;
    const auto waits = [](const auto& one) { return !one.second.waiting.empty(); };
    for (int turn = 0; turn < kTurns && std::any_of(clients_.begin(), clients_.end(), waits); ++turn) serve();
    for (const auto& one : clients_) dropped_ += one.second.waiting.size();
  }

 private:
  static std::string message_bytes(std::uint32_t subscription, std::uint64_t time, std::string_view data) {
    constexpr char kMessageData = 1;
    std::string bytes(LWS_PRE, '\0');
    bytes += kMessageData;
    for (unsigned shift = 0; shift < 32; shift += 8)
      bytes += static_cast<char>(subscription >> shift & 0xFFU);
    for (unsigned shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(time >> shift & 0xFFU);
    return bytes.append(data);
  }
  void send(lws* link, LiveClient& client, std::string bytes, lws_write_protocol kind) {
    if (client.waiting_bytes > kMostWaiting) {
      ++dropped_;
      return;
    }
    client.waiting.push_back({std::move(bytes), kind});
    client.waiting_bytes += client.waiting.back().size();
    lws_callback_on_writable(link);
  }
  void send(lws* link, LiveClient& client, const Json& json) {
    send(link, client, std::string(LWS_PRE, '\0') + json.dump(-1, ' ', false, Json::error_handler_t::replace),
         LWS_WRITE_TEXT);
  }
  void welcome(lws* link) {
    LiveClient& client = clients_[link];
    send(link, client,
         {{"op", "serverInfo"},
          {"name", name_},
          {"capabilities", Json::array()},
          {"metadata", Json::object()}});
    send(link, client, {{"op", "advertise"}, {"channels", channels_}});
  }
  // false: the connection is broken.
  bool write(lws* link) {
    LiveClient& client = clients_[link];
    while (!client.waiting.empty()) {
      Packet& packet = client.waiting.front();
      auto* const bytes = reinterpret_cast<unsigned char*>(packet.bytes.data()) + LWS_PRE;
      if (lws_write(link, bytes, packet.size(), packet.kind) < static_cast<int>(packet.size())) return false;
      client.waiting_bytes -= packet.size();
      client.waiting.pop_front();
      if (lws_send_pipe_choked(link) != 0) break;
    }
    if (!client.waiting.empty()) lws_callback_on_writable(link);
    return true;
  }
  // false: it talks too much.
  bool receive(lws* link, std::string_view part) {
    LiveClient& client = clients_[link];
    client.request += part;
    if (client.request.size() > kLongestRequest) return false;
    if (lws_is_final_fragment(link) == 0 || lws_remaining_packet_payload(link) != 0) return true;
    const std::string text = std::exchange(client.request, {});
    if (lws_frame_is_binary(link) == 0) obey(link, client, text);
    return true;
  }
  void obey(lws* link, LiveClient& client, const std::string& text) {
    try {
      const Json request = Json::parse(text);
      const std::string what = request.at("op");
      if (what == "subscribe") {
        for (const Json& one : request.at("subscriptions")) subscribe(link, client, one);
      } else if (what == "unsubscribe") {
        for (const Json& one : request.at("subscriptionIds")) client.channels.erase(number_of(one));
      } else {
        warn(link, client, "'" + what + "' is not supported");
      }
    } catch (const Json::exception&) {
      warn(link, client, "a request that is no subscribe or unsubscribe");
    } catch (const Error& e) {
      warn(link, client, e.what());
    }
  }
  void subscribe(lws* link, LiveClient& client, const Json& one) {
    const std::uint32_t channel = number_of(one.at("channelId")), id = number_of(one.at("id"));
    if (channel >= channels_.size())
      warn(link, client, fmt::format("there is no channel {}", channel));
    else if (client.channels.size() >= kMostSubscriptions)
      warn(link, client, "too many subscriptions");
    else
      add(link, client, id, static_cast<std::uint16_t>(channel));
  }
  void add(lws* link, LiveClient& client, std::uint32_t subscription, std::uint16_t channel) {
    client.channels[subscription] = channel;
    const Newest& newest = newest_[channel];
    if (!newest.data.empty())
      send(link, client, message_bytes(subscription, newest.time, newest.data), LWS_WRITE_BINARY);
  }
  void warn(lws* link, LiveClient& client, const std::string& text) {
    constexpr int kWarning = 1;
    send(link, client, {{"op", "status"}, {"level", kWarning}, {"message", text}});
  }

  static int callback(lws* link, lws_callback_reasons reason, void* user, void* in, std::size_t length) {
    auto* const self = static_cast<Server*>(lws_context_user(lws_get_context(link)));
    switch (reason) {
      case LWS_CALLBACK_ESTABLISHED:
        self->welcome(link);
        break;
      case LWS_CALLBACK_SERVER_WRITEABLE:
        return self->write(link) ? 0 : -1;
      case LWS_CALLBACK_RECEIVE:
        return self->receive(link, {static_cast<const char*>(in), length}) ? 0 : -1;
      case LWS_CALLBACK_CLOSED:
        self->clients_.erase(link);
        break;
      default:  // also answers a browser that asks for a page: 404
        return lws_callback_http_dummy(link, reason, user, in, length);
    }
    return 0;
  }

  static constexpr std::size_t kMostSubscriptions = 1000;
  std::array<lws_protocols, 2> protocols_{{{kProtocol, callback, 0, 0, 0, nullptr, 0}, {}}};
  std::string name_;
  lws_context* context_ = nullptr;
  lws_vhost* vhost_ = nullptr;
  std::vector<Json> schemas_, channels_;
  std::vector<Newest> newest_;  // of each channel
  std::map<lws*, LiveClient> clients_;
  std::uint64_t dropped_ = 0;
};

constexpr LiveModule kLive{.open = [](const std::string& address, std::uint16_t port,
                                      const std::string& name) -> std::unique_ptr<LiveServer> {
  return std::make_unique<Server>(address, port, name);
}};

}  // namespace
}  // namespace enc::app

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  static const enc::ModuleInfo kInfo{.name = "live", .live = &enc::app::kLive};
  return &kInfo;
}
