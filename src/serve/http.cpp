// serve/http.cpp - what every route of the server has in common.
// SPDX-License-Identifier: Apache-2.0
#include "serve/http.h"

#include "base/json/json_text.h"
#include "base/log.h"

#include "serve/answers.h"
#include "serve/connections.h"
#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <new>
#include <strings.h>

namespace obscura::serve {

namespace {

constexpr size_t largest_json = 4U << 20U;
/// Fields of a form: no request knows as many.
constexpr size_t max_fields = 256;
/// What a form takes beside the file in it.
constexpr uint64_t form_bytes = 1U << 20U;

/// Whether the head of the request that this thread answers was understood.
thread_local bool is_routed = false;

tl::unexpected<Error> too_large(const std::string& where, uint64_t bytes) {
    return fail(ExitCode::refused,
                "E-SERVE-SIZE",
                where,
                "larger than " + std::to_string(bytes) + " bytes, which is the most");
}

void send(Answer&& answer, httplib::Response& response) {
    response.status = answer.status;
    for (const auto& [name, value] : answer.headers)
        response.set_header(name, value);
    if (answer.stream) {
        response.set_chunked_content_provider(
            answer.type, [stream = std::move(answer.stream)](size_t, httplib::DataSink& sink) {
                return stream(sink);
            });
        return;
    }
    if (answer.part && answer.size > 0) {
        response.set_content_provider(answer.size, answer.type, std::move(answer.part));
        return;
    }
    if (answer.bytes.empty()) {
        response.set_content(answer.body, answer.type);
        return;
    }
    const auto provide = [bytes = answer.bytes, owner = answer.owner](
                             size_t offset, size_t length, httplib::DataSink& sink) {
        return sink.write(bytes.data() + offset, length);
    };
    response.set_content_provider(answer.bytes.size(), answer.type, provide);
}

void send(Result<Answer>&& answer, httplib::Response& response) {
    if (answer) {
        send(std::move(*answer), response);
        return;
    }
    const Error& error = answer.error();
    send(json_result(error_answer(error), http_status_of(error)), response);
}

void send_or_say(Result<Answer>&& answer, httplib::Response& response) {
    if (answer) {
        send(std::move(*answer), response);
        return;
    }
    const Error& error = answer.error();
    Answer told;
    told.status = simple_status_of(error);
    told.type = "text/plain; charset=utf-8";
    told.body = error_text(error);
    told.headers = {{"Cache-Control", "no-store"}};
    send(std::move(told), response);
}

Sender sender_of(const httplib::Request& request) {
    return {request.get_header_value("Host"),
            request.get_header_value("Origin"),
            request.get_header_value("Authorization"),
            request.has_param("token") ? request.get_param_value("token") : ""};
}

/// The library cuts answers, errors too, without asking whether they have such bytes, and leaves
/// their status. Who asks for a range may be given all (RFC 9110, 14.2).
void ignore_range(const httplib::Request& request) {
    const_cast<httplib::Ranges&>(request.ranges).clear();
}

/// What Content-Length says: digits, or nothing.
uint64_t length_of(const httplib::Request& request) {
    return std::strtoull(request.get_header_value("Content-Length").c_str(), nullptr, 10);
}

/// Whether two programs could read the request differently, one of them before this server: where
/// its body ends, or whom it is for (RFC 9112, 3.2 and 6.3).
bool is_ambiguous(const httplib::Request& request) {
    const auto count = [&](const char* name) { return request.get_header_value_count(name); };
    const std::string length = request.get_header_value("Content-Length");
    const bool is_number = length.find_first_not_of("0123456789") == std::string::npos;
    const std::string coding = request.get_header_value("Transfer-Encoding");
    const bool is_known = coding.empty() || ::strcasecmp(coding.c_str(), "chunked") == 0;
    return count("Host") > 1 || count("Content-Length") + count("Transfer-Encoding") > 1 ||
           !is_number || !is_known;
}

bool has_body(const httplib::Request& request) {
    return request.has_header("Transfer-Encoding") || length_of(request) > 0;
}

/// The connection ends after the answer: what else comes on it cannot be told from a request.
void end_after(httplib::Response& response) {
    response.set_header("Connection", "close");
}

bool ends_after(const httplib::Response& response) {
    return response.get_header_value("Connection") == "close";
}

/// For answers that the library makes itself.
Error error_of_status(int status) {
    constexpr int not_found = 404, too_large = 413;
    if (status == not_found)
        return {ExitCode::usage, "E-SERVE-UNKNOWN", "path", "there is nothing here"};
    if (status == too_large)
        return {ExitCode::refused, "E-SERVE-SIZE", "body", "the request is too large"};
    return {
        ExitCode::bad_data, "E-SERVE-REQUEST", "request", "it is no request that is understood"};
}

}  // namespace

Answer json_result(const Json& json, int status) {
    Answer out;
    out.status = status;
    out.body = json_line(json) + "\n";
    out.headers = {{"Cache-Control", "no-store"}};
    return out;
}

/// A request that names no length has no body; reading one would wait for the connection's end.
Body::Body(const httplib::Request& request,
           const httplib::ContentReader& reader,
           uint64_t max_bytes)
    : request_(request),
      reader_(reader),
      max_bytes_(max_bytes),
      is_read_(!request.has_header("Content-Length") && !request.has_header("Transfer-Encoding")),
      is_whole_(is_read_) {}

Result<void> Body::read(const ByteSink& sink) {
    if (request_.is_multipart_form_data())
        return fail(ExitCode::bad_data, "E-SERVE-BODY", "body", "expected the data, not a form");
    if (is_read_) return {};
    // Said before more comes than the library takes, which would be an error without a reason.
    if (length_of(request_) > max_bytes_) return too_large("body", max_bytes_);
    is_read_ = true;
    Result<void> done;
    is_whole_ = reader_([&](const char* bytes, size_t count) {
        if (done) done = sink(std::as_bytes(std::span(bytes, count)));
        return true;
    });
    if (!done) return done;
    if (!is_whole_) {
        return fail(
            ExitCode::bad_data, "E-SERVE-BODY", "body", "the request ends before all of it came");
    }
    return {};
}

void Body::drain() {
    if (is_read_) return;
    is_read_ = true;
    const auto forget = [](const char* /*bytes*/, size_t /*count*/) { return true; };
    is_whole_ = request_.is_multipart_form_data()  // for which the library has another reader
                    ? reader_([](const auto& /*part*/) { return true; }, forget)
                    : reader_(forget);
}

Result<nlohmann::json> Body::json() {
    const std::string type = request_.get_header_value("Content-Type");
    const std::string essence = type.substr(0, type.find_first_of("; \t"));
    if (::strcasecmp(essence.c_str(), "application/json") != 0) {
        return fail(ExitCode::refused,
                    "E-SERVE-TYPE",
                    "Content-Type",
                    "expected a body of application/json");
    }
    std::string text;
    const auto read_all = read([&](std::span<const std::byte> more) -> Result<void> {
        if (text.size() + more.size() > largest_json) return too_large("body", largest_json);
        text.append(reinterpret_cast<const char*>(more.data()), more.size());
        return {};
    });
    if (!read_all) return fail(read_all.error());
    Log log;
    return parse_json_text(text, "body", log);
}

Result<std::map<std::string, std::string>> Body::form(uint64_t max_bytes) {
    std::map<std::string, std::string> out;
    if (!request_.is_multipart_form_data())
        return fail(ExitCode::bad_data, "E-SERVE-BODY", "form", "expected multipart/form-data");
    if (is_read_) return out;
    if (length_of(request_) > max_bytes_ + form_bytes) return too_large("form", max_bytes_);
    is_read_ = true;
    bool has_too_many = false;
    std::string* field = nullptr;
    std::string repeated;
    uint64_t bytes = 0;
    is_whole_ = reader_(
        [&](const httplib::MultipartFormData& part) {
            has_too_many = out.size() == max_fields;
            const auto [place, is_new] = out.try_emplace(part.name);
            if (!is_new) repeated = part.name;
            field = &place->second;
            return !has_too_many;
        },
        [&](const char* data, size_t count) {
            bytes += count;
            if (bytes <= max_bytes) field->append(data, count);
            return true;
        });
    if (bytes > max_bytes) return too_large("form", max_bytes);
    if (has_too_many) {
        return fail(ExitCode::refused,
                    "E-SERVE-SIZE",
                    "form",
                    "more than " + std::to_string(max_fields) + " fields, which is the most");
    }
    if (!repeated.empty())
        return fail(ExitCode::bad_data, "E-SERVE-BODY", repeated, "the form has this field twice");
    if (is_whole_ && !out.empty()) return out;
    return fail(ExitCode::bad_data,
                "E-SERVE-BODY",
                "form",
                out.empty() ? "it has no fields; Content-Type must name the boundary between them"
                            : "it ends before its time");
}

Result<void> Routes::admit(const httplib::Request& request) const {
    note_request();
    const Sender sender = sender_of(request);
    if (auto own = guard_.check_site(sender); !own) return own;
    return guard_.check_token(sender);
}

Routes::Routes(httplib::Server& server, const Guard& guard, uint64_t max_body)
    : server_(server), guard_(guard), max_body_(max_body) {
    server.set_payload_max_length(max_body + form_bytes);
}

void Routes::get_openly(const std::string& pattern, const Get& get) {
    server_.Get(pattern, [=, this](const httplib::Request& request, httplib::Response& response) {
        note_request();
        const auto own = guard_.check_site(sender_of(request));
        send(own ? get(request) : Result<Answer>(fail(own.error())), response);
    });
}

void Routes::get(const std::string& pattern, const Get& get) {
    server_.Get(pattern, [=, this](const httplib::Request& request, httplib::Response& response) {
        const auto admitted = admit(request);
        send(admitted ? get(request) : Result<Answer>(fail(admitted.error())), response);
    });
}

httplib::Server::HandlerWithContentReader Routes::with_body(const WithBody& work, Send send) const {
    return [=, this](const httplib::Request& request,
                     httplib::Response& response,
                     const httplib::ContentReader& reader) {
        Body body(request, reader, max_body_);
        const auto admitted = admit(request);
        Result<Answer> answer =
            admitted ? work(request, body) : Result<Answer>(fail(admitted.error()));
        body.drain();
        send(std::move(answer), response);
        if (!body.is_whole()) end_after(response);
    };
}

void Routes::post(const std::string& pattern, const WithBody& work) {
    server_.Post(pattern, with_body(work, send));
}

void Routes::post_for_people(const std::string& pattern, const WithBody& work) {
    server_.Post(pattern, with_body(work, send_or_say));
}

void Routes::put(const std::string& pattern, const WithBody& work) {
    server_.Put(pattern, with_body(work, send));
}

void Routes::remove(const std::string& pattern, const WithBody& work) {
    server_.Delete(pattern, with_body(work, send));
}

void Routes::refuse_the_rest() {
    const WithBody nothing = [](const auto& /*request*/, Body& /*body*/) -> Result<Answer> {
        return fail(error_of_status(404));
    };
    post(".*", nothing);
    put(".*", nothing);
    remove(".*", nothing);
    server_.Patch(".*", with_body(nothing, send));
    server_.set_pre_routing_handler([](const httplib::Request& request,
                                       httplib::Response& response) {
        is_routed = true;
        ignore_range(request);
        if (is_ambiguous(request)) {
            constexpr int bad_request = 400;
            send(json_result(error_answer(error_of_status(bad_request)), bad_request), response);
            end_after(response);
            return httplib::Server::HandlerResponse::Handled;
        }
        constexpr std::array<std::string_view, 6> known = {
            "GET", "HEAD", "POST", "PUT", "PATCH", "DELETE"};
        const bool is_known = std::find(known.begin(), known.end(), request.method) != known.end();
        constexpr std::array<std::string_view, 4> with_body = {"POST", "PUT", "PATCH", "DELETE"};
        const bool reads_body =
            std::find(with_body.begin(), with_body.end(), request.method) != with_body.end();
        if (!reads_body && has_body(request)) end_after(response);
        if (is_known) return httplib::Server::HandlerResponse::Unhandled;
        constexpr int not_allowed = 405;
        send(json_result(error_answer(error_of_status(not_allowed)), not_allowed), response);
        return httplib::Server::HandlerResponse::Handled;
    });
    server_.set_logger([](const httplib::Request& /*request*/, const httplib::Response& response) {
        is_routed = false;
        if (ends_after(response)) end_connection();
    });
    server_.set_error_handler([](const httplib::Request& /*request*/, httplib::Response& response) {
        if (!is_routed) end_after(response);  // its head was not understood: where does it end?
        if (!response.body.empty() || response.content_length_ > 0) return;
        send(json_result(error_answer(error_of_status(response.status)), response.status),
             response);
    });
    server_.set_exception_handler([](const httplib::Request& /*request*/,
                                     httplib::Response& response,
                                     const std::exception_ptr& cause) {
        Error error{ExitCode::internal, "E-INTERNAL", "server", "an exception of unknown kind"};
        try {
            std::rethrow_exception(cause);
        } catch (const std::bad_alloc&) {
            error = {ExitCode::out_of_memory, "E-MEM", "server", "out of memory"};
        } catch (const std::exception& known) {
            error.message = known.what();
        } catch (...) {  // keeps its message
        }
        send(Result<Answer>(fail(std::move(error))), response);
    });
}

}  // namespace obscura::serve
