// serve/http.h - cpp-httplib, with what every route of the server has in common.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json/json.h"

#include "serve/guard.h"
#include <functional>
#include <httplib.h>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace obscura::serve {

/// What a client gets.
struct Answer {
    int status = 200;
    std::string type = "application/json";
    std::string body = {};
    /// In place of `body`, kept alive by `owner` until it is sent.
    std::span<const char> bytes = {};
    std::shared_ptr<const void> owner = {};
    /// In place of both: called until it calls sink.done(), or returns false: the client is gone.
    std::function<bool(httplib::DataSink& sink)> stream = {};
    /// In place of these: hands over some of the `size` bytes, from an offset on.
    std::function<bool(size_t offset, size_t length, httplib::DataSink& sink)> part = {};
    size_t size = 0;
    std::vector<std::pair<std::string, std::string>> headers = {};
};

Answer json_result(const Json& json, int status = 200);

/// The body of a request. What nobody reads is read and thrown away in the end.
class Body {
public:
    /// In      max_bytes: of data that is no JSON
    Body(const httplib::Request& request, const httplib::ContentReader& reader, uint64_t max_bytes);

    /// Hands over all of it. After an error of the sink the rest is thrown away.
    ///
    /// Errors  those of the sink; 65 E-SERVE-BODY it ends before its time
    Result<void> read(const ByteSink& sink);
    /// The text of a JSON object.
    ///
    /// Errors  77 E-SERVE-TYPE the request does not say that it is JSON; E-SERVE-SIZE; 65 E-JSON-*
    Result<nlohmann::json> json();
    /// The fields of a form as browsers and curl send it, each with its bytes.
    ///
    /// Errors  77 E-SERVE-SIZE; 65 E-SERVE-BODY
    Result<std::map<std::string, std::string>> form(uint64_t max_bytes);
    void drain();
    /// Whether nothing of it is left: else the rest would be taken for the next request.
    bool is_whole() const { return is_whole_; }

private:
    const httplib::Request& request_;
    const httplib::ContentReader& reader_;
    const uint64_t max_bytes_;
    bool is_read_;
    bool is_whole_;
};

/// Makes routes: each is called for those whom the guard lets in.
class Routes {
public:
    using Get = std::function<Result<Answer>(const httplib::Request&)>;
    using WithBody = std::function<Result<Answer>(const httplib::Request&, Body&)>;

    /// In      max_body: bytes of a request's body, or of the file in a form
    Routes(httplib::Server& server, const Guard& guard, uint64_t max_body);

    /// Open to all who name this server: without the token.
    void get_openly(const std::string& pattern, const Get& get);
    void get(const std::string& pattern, const Get& get);
    void post(const std::string& pattern, const WithBody& work);
    /// As post, but errors are plain text: for clients that show people what they get.
    void post_for_people(const std::string& pattern, const WithBody& work);
    void put(const std::string& pattern, const WithBody& work);
    void remove(const std::string& pattern, const WithBody& work);
    /// For all that no route is for, and for faults of the protocol. To be called last.
    void refuse_the_rest();

private:
    Result<void> admit(const httplib::Request& request) const;
    using Send = void (*)(Result<Answer>&&, httplib::Response&);
    httplib::Server::HandlerWithContentReader with_body(const WithBody& work, Send send) const;

    httplib::Server& server_;
    const Guard& guard_;
    const uint64_t max_body_;
};

}  // namespace obscura::serve
