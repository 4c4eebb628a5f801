# The program in a small image: docker build -t obscura . && docker run --rm -v "$PWD:/work" obscura render scene.glb
# SPDX-License-Identifier: Apache-2.0
FROM debian:12-slim AS build
COPY . /source
WORKDIR /source
RUN bash -c 'source scripts/setup.sh && install_packages build package' \
    && cmake --preset release -DOBSCURA_TESTS=OFF -DOBSCURA_WERROR=OFF -DCMAKE_INSTALL_PREFIX=/usr \
    && cmake --build --preset release \
    && cd build/release && cpack -G DEB && mkdir /packages && mv ./*.deb /packages

FROM debian:12-slim
RUN --mount=type=bind,from=build,source=/packages,target=/packages \
    apt-get update \
    && apt-get install -y --no-install-recommends /packages/*.deb \
    && rm -rf /var/lib/apt/lists/* \
    && useradd --create-home obscura
USER obscura
WORKDIR /work
ENTRYPOINT ["obscura"]
CMD ["--help"]
