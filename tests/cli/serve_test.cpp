// tests/cli/serve_test.cpp - `obscura serve` and `obscura view`, asked over HTTP.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <arpa/inet.h>
#include <fstream>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* json_type = "application/json";

/// A client of a server that runs.
struct ServerClient {
    int port = 0;
    std::string token;
    httplib::Client http;

    ServerClient(int at, std::string known)
        : port(at), token(std::move(known)), http("127.0.0.1", at) {
        http.set_keep_alive(true);
        http.set_bearer_token_auth(token);
        http.set_read_timeout(60);
    }

    json get(const std::string& path, int status = 200) {
        const auto answer = http.Get(path);
        return read(answer, path, status);
    }
    json post(const std::string& path, const json& body, int status = 201) {
        return read(http.Post(path, body.dump(), json_type), path, status);
    }
    json put(const std::string& path, const json& body, int status = 200) {
        return read(http.Put(path, body.dump(), json_type), path, status);
    }
    json upload(const std::string& name, const std::string& bytes, int status = 201) {
        const std::string path = "/api/files?name=" + name;
        return read(http.Post(path, bytes, "application/octet-stream"), path, status);
    }

    /// The finished picture of a wish; its header and its codes.
    std::pair<json, std::string> picture(const std::string& view) {
        int after = 0;
        for (int i = 0; i < 200; ++i) {
            const auto answer =
                http.Get("/api/views/" + view + "/picture?after=" + std::to_string(after));
            if (!answer || answer->status == 204) continue;
            if (answer->status != 200) return {json::parse(answer->body), ""};
            const json header = json::parse(answer->get_header_value("X-Obscura-Image"));
            after = header.at("serial");
            if (header.at("done") == true) return {header, answer->body};
        }
        ADD_FAILURE() << "no finished picture";
        return {};
    }

    static json read(const httplib::Result& answer, const std::string& path, int status) {
        EXPECT_TRUE(answer) << path;
        if (!answer) return {};
        EXPECT_EQ(answer->status, status) << path << ": " << answer->body;
        EXPECT_EQ(answer->get_header_value("Content-Type"), json_type) << path;
        return json::parse(answer->body, nullptr, false);
    }
};

std::string error_id(const json& answer) {
    return answer.contains("error") ? answer["error"].value("id", "") : "OK";
}

class Serve : public Cli {
protected:
    /// Runs the server while `body` talks to it; then ends it as Ctrl-C does.
    template <typename Body>
    ProgramRun serve(const std::vector<std::string>& arguments, const Body& body) {
        std::vector<std::string> all = joined({"serve", "--port", "0"}, arguments);
        if (!arguments.empty() && arguments.front() == "view") all = arguments;
        ProgramSetup program = setup(all, folder_);
        bool has_begun = false;
        program.on_output = [&](const std::string& out, pid_t process) {
            static const std::regex form(R"(http://[^:]+:(\d+)/#token=([^&\s]+)(\S*)\n)");
            std::smatch match;
            if (has_begun || !std::regex_search(out, match, form)) return;
            has_begun = true;
            ServerClient client(std::stoi(match[1]), match[2]);
            opened_ = match[3];
            body(client);
            kill(process, SIGINT);
        };
        const ProgramRun got = run_program_with(program);
        EXPECT_TRUE(has_begun) << got.out << got.err;
        return got;
    }

    std::string opened_;  ///< the fragment's "&file=NAME"
};

TEST_F(Serve, AImageIsThatOfTheCommandThatItTells) {
    const ProgramRun got = serve({}, [&](ServerClient& client) {
        const json opened = client.post("/api/views", {{"file", "quad.gltf"}});
        EXPECT_EQ(opened.at("asset").at("name"), "quad.gltf");
        EXPECT_EQ(opened.at("asset").at("cameras")[0].at("name"), "Front");
        EXPECT_NEAR(opened.at("camera").at("eye")[2].get<double>(), 3, 1e-6);
        const std::string view = opened.at("view");
        const json options = {{"size", "40x24"},
                              {"spp", 6},
                              {"eye", {-1, 0.5, 3}},
                              {"exposure", -0.5},
                              {"page", "white"},
                              {"no-dither", true}};
        const json taken = client.put("/api/views/" + view, {{"options", options}});
        EXPECT_EQ(
            taken.at("command"),
            "obscura render quad.gltf --exposure=-0.5 --eye=-1,0.5,3 --no-dither --page white "
            "--size 40x24 --spp 6 -o quad.png");
        const auto [header, codes] = client.picture(view);
        EXPECT_EQ(header.at("samples"), 6);
        std::ofstream(folder_ / "codes", std::ios::binary) << codes;
        const auto saved = client.http.Get("/api/views/" + view + "/image?format=png");
        const auto plain = client.http.Get("/api/views/" + view + "/image");
        ASSERT_TRUE(saved && plain);
        EXPECT_EQ(saved->get_header_value("Content-Type"), "image/png");
        EXPECT_EQ(plain->get_header_value("Content-Type"), "image/png");
        EXPECT_EQ(plain->body, saved->body);
        std::ofstream(folder_ / "saved.png", std::ios::binary) << saved->body;
    });
    expect_result(got, 0, "OK");
    expect_result(run({"render",
                       "quad.gltf",
                       "--exposure=-0.5",
                       "--eye=-1,0.5,3",
                       "--no-dither",
                       "--page",
                       "white",
                       "--size",
                       "40x24",
                       "--spp",
                       "6",
                       "-o",
                       "quad.png"}),
                  0,
                  "OK");
    const auto rendered = read_image_file(folder_ / "quad.png");
    const auto saved = read_image_file(folder_ / "saved.png");
    ASSERT_TRUE(rendered && saved);
    EXPECT_EQ(saved->pixels, rendered->pixels);
    const std::string codes = read_whole_file(folder_ / "codes");
    ASSERT_EQ(codes.size(), rendered->pixels.size());
    for (size_t i = 0; i < codes.size(); ++i)
        ASSERT_EQ(static_cast<unsigned char>(codes[i]), std::lround(255 * rendered->pixels[i]));
}

TEST_F(Serve, UploadsAreOpenedByTheirNames) {
    serve({"--max-upload", "1M"}, [&](ServerClient& client) {
        const json sent = client.upload("triangle.gltf", gltf_text(triangle_scene()));
        const json opened = client.post("/api/views", {{"file", sent.at("file")}});
        const std::string view = opened.at("view");
        const json taken =
            client.put("/api/views/" + view, {{"options", {{"size", "8x8"}, {"spp", 1}}}});
        EXPECT_THAT(taken.at("command").get<std::string>(), HasSubstr("render triangle.gltf --"));
        EXPECT_EQ(client.picture(view).first.at("width"), 8);
        EXPECT_EQ(error_id(client.upload("a.exe", "MZ", 400)), "E-SERVE-NAME");
        const json broken = client.upload("broken.glb", "glTF no more");
        const json refused = client.post("/api/views", {{"file", broken.at("file")}}, 422);
        EXPECT_THAT(refused.at("error").at("place").get<std::string>(),
                    testing::StartsWith(broken.at("file").get<std::string>()));
        std::string thief = gltf_text(triangle_scene());
        const size_t uri = thief.find("data:");
        thief.replace(uri, thief.find('"', uri) - uri, "/etc/passwd");
        const json stolen = client.upload("thief.gltf", thief);
        EXPECT_EQ(error_id(client.post("/api/views", {{"file", stolen.at("file")}}, 403)),
                  "E-URI-REFUSED");
        for (const size_t bytes : {1100000U, 3000000U}) {
            EXPECT_EQ(error_id(client.upload("large.glb", std::string(bytes, 'x'), 413)),
                      "E-SERVE-SIZE");
        }
        EXPECT_EQ(client.get("/api/files").at("files").size(), 3U);
    });
}

TEST_F(Serve, StrangersAreRefused) {
    serve({}, [&](ServerClient& client) {
        const auto status = [&](const httplib::Headers& headers, const std::string& path) {
            httplib::Client other("127.0.0.1", client.port);
            const auto answer = other.Get(path, headers);
            return answer ? answer->status : 0;
        };
        const std::string token = "Bearer " + client.token;
        EXPECT_EQ(status({}, "/"), 200);
        EXPECT_EQ(status({}, "/api/files"), 401);
        EXPECT_EQ(status({{"Authorization", "Bearer wrong"}}, "/api/files"), 401);
        EXPECT_EQ(status({{"Authorization", token}}, "/api/files"), 200);
        EXPECT_EQ(status({{"Host", "evil.com"}}, "/"), 403);
        EXPECT_EQ(status({{"Host", "evil.com"}, {"Authorization", token}}, "/api/files"), 403);
        EXPECT_EQ(status({{"Origin", "http://evil.com"}, {"Authorization", token}}, "/api/files"),
                  403);
        for (const char* path : {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/api/x%00"})
            EXPECT_EQ(status({{"Authorization", token}}, path), 404) << path;
        httplib::Client plain("127.0.0.1", client.port);
        const httplib::Headers known = {{"Authorization", token}};
        const auto crossed =
            plain.Post("/api/views", known, R"({"file": "quad.gltf"})", "text/plain");
        ASSERT_TRUE(crossed);
        EXPECT_EQ(crossed->status, 403);
        EXPECT_EQ(error_id(json::parse(crossed->body)), "E-SERVE-TYPE");
        const auto page = plain.Get("/");
        EXPECT_THAT(page->get_header_value("Content-Security-Policy"), HasSubstr("'none'"));
        EXPECT_EQ(page->get_header_value("Access-Control-Allow-Origin"), "");
    });
}

TEST_F(Serve, OnlyThisMachineReachesIt) {
    serve({}, [&](ServerClient& client) {
        char wanted[16];
        std::snprintf(wanted, sizeof wanted, ":%04X ", static_cast<unsigned>(client.port));
        int listeners = 0;
        for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
            std::ifstream in(table);
            for (std::string line; std::getline(in, line);) {
                constexpr const char* any_and_listening = "00000000:0000 0A";
                if (line.find(any_and_listening) == std::string::npos) continue;
                if (line.find(wanted) == std::string::npos) continue;
                ++listeners;
                EXPECT_THAT(line, HasSubstr("0100007F:"));
            }
        }
        EXPECT_EQ(listeners, 1);
    });
}

TEST_F(Serve, EveryErrorIsAnswered) {
    serve({}, [&](ServerClient& client) {
        const auto id = [&](const std::string& path, const json& body, int status) {
            return error_id(client.post(path, body, status));
        };
        EXPECT_EQ(id("/api/views", {{"file", "none.glb"}}, 404), "E-SCENE-MISSING");
        EXPECT_EQ(id("/api/views", {{"file", "../quad.gltf"}}, 403), "E-URI-REFUSED");
        EXPECT_EQ(id("/api/views", {{"file", 7}}, 400), "E-SERVE-BODY");
        EXPECT_EQ(id("/api/nothing", {}, 404), "E-SERVE-UNKNOWN");
        EXPECT_EQ(error_id(client.get("/nothing", 404)), "E-SERVE-UNKNOWN");
        const auto no_json = client.http.Post("/api/views", "{", json_type);
        EXPECT_EQ(error_id(ServerClient::read(no_json, "{", 422)), "E-JSON-SYNTAX");
        const json large = {{"file", std::string(5U << 20U, 'x')}};
        EXPECT_EQ(id("/api/views", large, 413), "E-SERVE-SIZE");
        EXPECT_EQ(error_id(client.put("/api/views/v9", {{"options", json::object()}}, 404)),
                  "E-SERVE-UNKNOWN");
        const std::string view = client.post("/api/views", {{"file", "quad.gltf"}}).at("view");
        const auto wish = [&](const json& options, int status) {
            return error_id(client.put("/api/views/" + view, {{"options", options}}, status));
        };
        EXPECT_EQ(error_id(client.get("/api/views/" + view + "/image", 400)), "E-VIEW-EMPTY");
        EXPECT_EQ(wish({{"ocio", "/etc/passwd"}}, 400), "E-USAGE");
        EXPECT_EQ(wish({{"output", "/tmp/x.png"}}, 400), "E-USAGE");
        EXPECT_EQ(wish({{"env", "/etc/passwd"}}, 403), "E-URI-REFUSED");
        EXPECT_EQ(wish({{"spp", "many"}}, 400), "E-USAGE-NUMBER");
        EXPECT_EQ(wish({{"spp", {{"a", 1}}}}, 400), "E-USAGE-CHOICE");
        EXPECT_EQ(wish({{"exposure", "auto"}}, 400), "E-USAGE-CHOICE");
        EXPECT_EQ(wish({{"camera", "None"}, {"size", "8x8"}}, 200), "OK");
        const auto [failure, nothing] = client.picture(view);
        EXPECT_EQ(error_id(failure), "E-CAM-UNKNOWN");
        EXPECT_EQ(error_id(client.get("/api/views/" + view + "/pick?x=2&y=0", 400)),
                  "E-USAGE-RANGE");
        for (const char* serial : {"abc", "1x", "-1", "99999999999"}) {
            const std::string path = "/api/views/" + view + "/picture?after=" + serial;
            EXPECT_EQ(error_id(client.get(path, 400)), "E-USAGE-RANGE");
        }
        const auto closed = client.http.Delete("/api/views/" + view);
        ServerClient::read(closed, "DELETE", 200);
        EXPECT_EQ(error_id(client.get("/api/views/" + view + "/picture", 404)), "E-SERVE-UNKNOWN");
    });
}

TEST_F(Serve, ThingsToChooseAreListed) {
    serve({}, [&](ServerClient& client) {
        const json choices = client.get("/api/choices");
        EXPECT_EQ(choices.at("layers")[0].at("name"), "path");
        EXPECT_GE(choices.at("displays")[0].at("views").size(), 2U);
        EXPECT_EQ(client.get("/api/files").at("files")[0],
                  json({{"file", "box.gltf"}, {"kind", "model"}}));
    });
}

/// Sends text as it is and returns what comes back until the connection ends or a second is over.
std::string raw_answer(int port, const std::string& text) {
    const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    timeval second = {1, 0};
    ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &second, sizeof second);
    std::string out;
    if (::connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
        (void)::send(connection, text.data(), text.size(), MSG_NOSIGNAL);
        char buffer[4096];
        for (ssize_t count = 0; (count = ::recv(connection, buffer, sizeof buffer, 0)) > 0;)
            out.append(buffer, static_cast<size_t>(count));
    }
    ::close(connection);
    return out;
}

TEST_F(Serve, BrokenRequestsAndVanishingClientsDoNoHarm) {
    serve({}, [&](ServerClient& client) {
        EXPECT_THAT(raw_answer(client.port, "nonsense\r\n\r\n"), HasSubstr(" 400 "));
        const std::string odd =
            raw_answer(client.port, "PRI / HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_THAT(odd, HasSubstr(" 405 "));
        EXPECT_THAT(odd, HasSubstr("E-SERVE-REQUEST"));
        // What a refused request brings along is not taken for the next one.
        const std::string inner = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
        const std::string outer =
            "POST /api/views HTTP/1.1\r\nHost: localhost\r\n"
            "Content-Length: " +
            std::to_string(inner.size()) + "\r\n\r\n" + inner;
        const std::string answer = raw_answer(client.port, outer);
        EXPECT_THAT(answer, HasSubstr(" 401 "));
        EXPECT_THAT(answer, testing::Not(HasSubstr(" 200 ")));
        const std::string view = client.post("/api/views", {{"file", "quad.gltf"}}).at("view");
        client.put("/api/views/" + view, {{"options", {{"size", "640x360"}, {"spp", 100000}}}});
        for (int i = 0; i < 20; ++i) {
            httplib::Client hasty("127.0.0.1", client.port);
            hasty.set_bearer_token_auth(client.token);
            hasty.set_read_timeout(0, 20000);
            hasty.Get("/api/views/" + view + "/picture?after=100000");
        }
        client.put("/api/views/" + view, {{"options", {{"size", "8x8"}, {"spp", 1}}}});
        EXPECT_EQ(client.picture(view).first.at("width"), 8);
    });
}

TEST_F(Serve, RequestsThatCanBeReadInTwoWaysAreRefused) {
    serve({}, [&](ServerClient& client) {
        const std::string next = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
        for (const std::string headers : {"Content-Length: 0\r\nContent-Length: 40\r\n",
                                          "Content-Length: 40\r\nTransfer-Encoding: chunked\r\n",
                                          "Content-Length: +0\r\n",
                                          "Host: 127.0.0.1\r\n"}) {
            const std::string request = "POST /api/views HTTP/1.1\r\nHost: localhost\r\n";
            const std::string answer =
                raw_answer(client.port, request + headers + "\r\n" + next + next);
            EXPECT_THAT(answer, HasSubstr(" 400 ")) << headers;
            EXPECT_THAT(answer, HasSubstr("E-SERVE-REQUEST")) << headers;
            EXPECT_THAT(answer, HasSubstr("Connection: close")) << headers;
            EXPECT_THAT(answer, testing::Not(HasSubstr(" 200 "))) << headers;
        }
        EXPECT_THAT(raw_answer(client.port, next), HasSubstr(" 200 "));
    });
}

TEST_F(Serve, ABodyIsNeverTakenForARequest) {
    serve({}, [&](ServerClient& client) {
        const std::string inner = "GET /icon.svg HTTP/1.1\r\nHost: localhost\r\n\r\n";
        const std::string length = "Content-Length: " + std::to_string(inner.size()) + "\r\n";
        const std::string host = " HTTP/1.1\r\nHost: localhost\r\n";
        const std::string form = "Content-Type: multipart/form-data\r\n";
        for (const std::string& head : {"GET /page.js" + host + length,
                                        "HEAD /page.js" + host + length,
                                        "GET /nothing" + host + length,
                                        "OPTIONS /" + host + length,
                                        "POST /render" + host + form + length,
                                        "POST /api/views" + host + "Transfer-Encoding: gzip\r\n",
                                        "GET /" + std::string(20000, 'x') + host + length}) {
            const std::string answer = raw_answer(client.port, head + "\r\n" + inner);
            EXPECT_THAT(answer, HasSubstr("HTTP/1.1 ")) << head.substr(0, 60);
            EXPECT_THAT(answer, testing::Not(HasSubstr("image/svg"))) << head.substr(0, 60);
        }
        EXPECT_THAT(raw_answer(client.port, inner), HasSubstr("image/svg"));
    });
}

TEST_F(Serve, ViewShowsOneModel) {
    std::filesystem::create_directories(folder_ / "models");
    folder_.write("models/two words.gltf", gltf_text(triangle_scene()));
    const ProgramRun got =
        serve({"view", "models/two words.gltf", "--no-browser"}, [&](ServerClient& client) {
            EXPECT_EQ(opened_, "&file=two%20words.gltf");
            const json opened = client.post("/api/views", {{"file", "two words.gltf"}});
            EXPECT_EQ(opened.at("asset").at("triangles"), 1);
            EXPECT_EQ(client.get("/api/files").at("files").size(), 1U);
        });
    expect_result(got, 0, "OK");
    expect_result(run({"view", "none.glb"}), 66, "E-SCENE-MISSING");
}

TEST_F(Serve, MistakesAreRefused) {
    expect_result(run({"serve", "--root", "none"}), 64, "E-SERVE-ROOT");
    expect_result(run({"serve", "--listen", "0.0.0.0"}), 64, "E-USAGE-CONFLICT");
    expect_result(run({"serve", "--listen", "0.0.0.0", "--no-token"}), 64, "E-USAGE-CONFLICT");
    expect_result(run({"serve", "--token", ""}), 64, "E-USAGE-CONFLICT");
    expect_result(run({"serve", "--port", "70000"}), 64, "E-USAGE-RANGE");
    expect_result(run({"serve", "--listen", "203.0.113.1", "--token", "x"}), 69, "E-SERVE-LISTEN");
    serve({}, [&](ServerClient& client) {
        expect_result(run({"serve", "--port", std::to_string(client.port)}), 69, "E-SERVE-LISTEN");
    });
}

}  // namespace
}  // namespace obscura
