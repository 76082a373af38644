// A real browser, driven as a person would: clicks, keys, screenshots. Chromium by its debugging protocol over two
// pipes.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace odds::report {

/// Throws std::runtime_error if the browser ends, or says nothing for two minutes.
class Browser {
 public:
  using Json = nlohmann::json;

  [[nodiscard]] static bool is_installed() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

  explicit Browser(const std::filesystem::path& profile) {
    int to[2];
    int from[2];
    if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) run(to[0], from[1], "--user-data-dir=" + profile.string());
    ::close(to[0]);
    ::close(from[1]);
    write_ = to[1];
    read_ = from[0];
    if (child_ < 0) throw std::runtime_error("no process for the browser");
    const std::string target = call("Target.createTarget", {{"url", "about:blank"}}).at("targetId");
    session_ = call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}}).at("sessionId");
    call("Page.enable");
    call("Runtime.enable");
    call("Emulation.setDeviceMetricsOverride",
         {{"width", 1200}, {"height", 1000}, {"deviceScaleFactor", 1}, {"mobile", false}});
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;
  ~Browser() {
    ::close(write_);  // it ends when nobody speaks to it any more
    ::close(read_);
    if (child_ > 0) ::waitpid(child_, nullptr, 0);
  }

  void open(const std::string& url) {
    loaded_ = false;
    call("Page.navigate", {{"url", url}});
    while (!loaded_) receive();
  }
  /// What an expression gives in the page; a promise is waited for.
  Json evaluate(const std::string& expression) {
    const Json result =
        call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (result.contains("exceptionDetails")) throw std::runtime_error(result["exceptionDetails"].dump());
    return result.at("result").value("value", Json());
  }
  /// Presses and releases the left button on an element, at a share of its width.
  void click(const std::string& id, double across = 0.5) {
    const Json at = evaluate("(() => { const e = document.getElementById('" + id +
                             "'); e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect();"
                             "return [r.left, r.top + r.height / 2, r.width]; })()");
    const double x = at[0].get<double>() + across * at[2].get<double>();
    mouse("mousePressed", x, at[1], 1);
    mouse("mouseReleased", x, at[1], 1);
  }
  /// Drags with the left button, from the middle of an element.
  void drag(const std::string& id, double by_x, double by_y) {
    const Json at = evaluate("(() => { const e = document.getElementById('" + id +
                             "'); e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect();"
                             "return [r.left + r.width / 2, r.top + r.height / 2]; })()");
    mouse("mousePressed", at[0], at[1], 1);
    mouse("mouseMoved", at[0].get<double>() + by_x, at[1].get<double>() + by_y, 1);
    mouse("mouseReleased", at[0].get<double>() + by_x, at[1].get<double>() + by_y, 1);
  }
  void key(const std::string& name, const std::string& text = "") {
    Json event = {{"type", "keyDown"}, {"key", name}};
    if (!text.empty()) event["text"] = text;
    call("Input.dispatchKeyEvent", event);
    call("Input.dispatchKeyEvent", {{"type", "keyUp"}, {"key", name}});
  }
  /// The element as it is on the screen: a PNG in base64.
  std::string screenshot(const std::string& id) {
    const Json r =
        evaluate("(() => { const r = document.getElementById('" + id +
                 "').getBoundingClientRect(); return [r.left + scrollX, r.top + scrollY, r.width, r.height]; })()");
    return call("Page.captureScreenshot",
                {{"format", "png"},
                 {"clip", {{"x", r[0]}, {"y", r[1]}, {"width", r[2]}, {"height", r[3]}, {"scale", 1}}}})
        .at("data");
  }

 private:
  [[noreturn]] static void run(int in, int out, const std::string& profile) {
    // The protocol is spoken on descriptors 3 and 4; the copies stay open across exec.
    const int safe_in = ::fcntl(in, F_DUPFD, 10);
    const int safe_out = ::fcntl(out, F_DUPFD, 10);
    ::dup2(safe_in, 3);
    ::dup2(safe_out, 4);
    ::close(safe_in);
    ::close(safe_out);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3; ++fd) ::dup2(nowhere, fd);
    ::execlp("chromium", "chromium", "--headless", "--no-sandbox", "--remote-debugging-pipe", "--disable-gpu",
             "--use-gl=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", profile.c_str(),
             static_cast<char*>(nullptr));
    ::_exit(127);
  }

  void mouse(const char* type, double x, double y, int buttons) {
    call("Input.dispatchMouseEvent",
         {{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"buttons", buttons}, {"clickCount", 1}});
  }

  Json call(const std::string& method, const Json& parameters = Json::object()) {
    const int id = ++last_id_;
    Json message = {{"id", id}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump();
    for (std::size_t sent = 0; sent <= text.size();) {  // with the closing zero
      const ssize_t wrote = ::write(write_, text.c_str() + sent, text.size() + 1 - sent);
      if (wrote <= 0) throw std::runtime_error("the browser has gone");
      sent += static_cast<std::size_t>(wrote);
    }
    for (;;) {
      const Json answer = receive();
      if (answer.value("id", 0) != id) continue;
      if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
      return answer.at("result");
    }
  }

  Json receive() {
    for (;;) {
      if (const std::size_t end = received_.find('\0'); end != std::string::npos) {
        const Json message = Json::parse(received_.substr(0, end));
        received_.erase(0, end + 1);
        if (message.value("method", "") == "Page.loadEventFired") loaded_ = true;
        return message;
      }
      constexpr int patience_ms = 120'000;
      pollfd ready{read_, POLLIN, 0};
      char block[1 << 14];
      if (::poll(&ready, 1, patience_ms) <= 0) throw std::runtime_error("the browser says nothing");
      const ssize_t got = ::read(read_, block, sizeof block);
      if (got <= 0) throw std::runtime_error("the browser has ended");
      received_.append(block, static_cast<std::size_t>(got));
    }
  }

  pid_t child_ = -1;
  int write_ = -1;
  int read_ = -1;
  int last_id_ = 0;
  bool loaded_ = false;
  std::string session_;
  std::string received_;
};

}  // namespace odds::report
