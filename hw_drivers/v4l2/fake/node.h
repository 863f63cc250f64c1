// A fake video device at the level of the ioctls: it answers them as a UVC camera does under Linux, and fills
// the buffers that its client queued.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include "core/base/time.h"
#include "core/devices/fake.h"
#include "hw_drivers/v4l2/wire/pixels.h"

namespace enc::v4l2 {

struct Mode {
  Pixels pixels = Pixels::yuyv;
  int width = 640, height = 480;
  double rate = 20.0;  // Hz
};
struct NodeSpec {
  std::string card{kFakeName};
  std::string bus = "encounter";
  std::vector<Mode> modes{Mode{}};
  bool captures = true;  // false: a device of metadata
  bool stamps = true;    // frames carry CLOCK_MONOTONIC
};

class Node {
 public:
  explicit Node(NodeSpec spec);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // An ioctl of a client with this number. Answers 0 or a negative error number; refuses data of a wrong
  // size.
  int control(int client, std::uint32_t request, std::span<std::byte> data);
  [[nodiscard]] int memory() const { return memory_; }  // of all buffers, a memfd; -1: none
  [[nodiscard]] int event() const { return event_; }    // an eventfd that counts the full buffers
  void leave(int client);                               // the client closed the device

  // A frame. False: no queued buffer, so the frame is lost.
  bool put(std::uint32_t sequence, Duration stamp, std::span<const std::uint8_t> bytes, bool damaged = false);
  [[nodiscard]] bool streams() const { return streams_; }
  [[nodiscard]] const Mode& mode() const { return mode_; }
  void fail(int error) { error_ = error; }  // of each DQBUF; 0: heals

 private:
  struct FilledBuffer {
    std::uint32_t index = 0, sequence = 0, used = 0;
    Duration stamp{};
    bool damaged = false;
  };
  template <class Data>
  int answer(int client, std::span<std::byte> data, int (Node::*what)(int, Data&));
  int query(int client, v4l2_capability& data);
  int list_format(int client, v4l2_fmtdesc& data);
  int list_size(int client, v4l2_frmsizeenum& data);
  int list_rate(int client, v4l2_frmivalenum& data);
  int get_format(int client, v4l2_format& data);
  int set_format(int client, v4l2_format& data);
  int get_rate(int client, v4l2_streamparm& data);
  int set_rate(int client, v4l2_streamparm& data);
  int request(int client, v4l2_requestbuffers& data);
  int query_buffer(int client, v4l2_buffer& data);
  int queue(int client, v4l2_buffer& data);
  int dequeue(int client, v4l2_buffer& data);
  int begin(int client, int& type);
  int end(int client, int& type);

  [[nodiscard]] bool busy(int client) const { return owner_ >= 0 && owner_ != client; }
  [[nodiscard]] std::size_t frame_bytes() const;
  void release();
  void forget_frames();

  NodeSpec spec_;
  Mode mode_;
  int owner_ = -1;  // the client with buffers
  int memory_ = -1, event_ = -1;
  std::uint8_t* bytes_ = nullptr;
  std::size_t each_ = 0, count_ = 0;  // bytes of a buffer; buffers
  std::deque<std::uint32_t> queued_;
  std::deque<FilledBuffer> filled_;
  std::vector<bool> is_queued_;
  bool streams_ = false;
  int error_ = 0;
};

}  // namespace enc::v4l2
