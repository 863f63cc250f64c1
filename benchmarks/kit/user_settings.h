// The user's --set. It records which settings a benchmark has used, so that none is ignored in silence.
#pragma once

#include <initializer_list>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace enc::bench {

class UserSettings {
 public:
  UserSettings() : UserSettings(std::vector<std::string>{}) {}
  UserSettings(std::vector<std::string> all) : all_(std::move(all)) {}
  UserSettings(std::initializer_list<std::string> all) : all_(all) {}

  [[nodiscard]] bool empty() const { return all_.empty(); }
  // Without a record, to look at or to filter.
  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

  // The whole list, as a benchmark that loads its scene itself takes it: each of its settings is used.
  operator const std::vector<std::string>&() const {
    for (const std::string& one : all_) use(one);
    return all_;
  }
  [[nodiscard]] auto begin() const { return static_cast<const std::vector<std::string>&>(*this).begin(); }
  [[nodiscard]] auto end() const { return all_.end(); }

  void use(const std::string& one) const;  // any thread may call it
  // Settings that were never used. Copies share their record.
  [[nodiscard]] std::vector<std::string> unused() const;

 private:
  struct Record {
    std::mutex turn;
    std::set<std::string> used;
  };
  std::vector<std::string> all_;
  std::shared_ptr<Record> record_ = std::make_shared<Record>();
};

}  // namespace enc::bench
