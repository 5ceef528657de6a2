# A container with the program and the Python module: docker build -t vantage .
#   docker run --rm -v "$PWD:/data" -w /data vantage match left.png right.png -o map.pfm
FROM debian:12-slim AS build
WORKDIR /vantage
COPY . .
RUN scripts/package

FROM debian:12-slim
COPY --from=build /vantage/build/packages/*vantage_*.deb /tmp/packages/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /tmp/packages/*.deb libcurl4 ca-certificates \
 && rm -rf /tmp/packages /var/lib/apt/lists/*
ENTRYPOINT ["vantage"]
