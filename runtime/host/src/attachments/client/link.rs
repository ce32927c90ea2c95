//! What carries requests to a server and its answers back: a connection over the network, or a serial line.

use super::rtu::Rtu;
use super::tcp::Tcp;
use super::trouble::Trouble;
use crate::attachments::line::Serial;
use crate::remote::Server;
use std::time::Duration;

#[derive(Debug)]
pub(super) enum Link {
    Tcp(Tcp),
    Serial(Rtu<Serial>),
}

impl Link {
    pub fn connect(server: &Server, timeout: Duration) -> Result<Self, Trouble> {
        match server {
            Server::Tcp(address) => Tcp::connect(address, timeout).map(Self::Tcp),
            Server::Serial(line) => {
                let port = Serial::open(line).map_err(|it| Trouble::Failed(it.to_string()))?;
                Ok(Self::Serial(Rtu::new(port, line)))
            }
        }
    }

    /// Sends a request to a unit, and appends its answer: both begin with the function.
    pub fn exchange(
        &mut self,
        unit: u8,
        timeout: Duration,
        request: &[u8],
        answer: &mut Vec<u8>,
    ) -> Result<(), Trouble> {
        match self {
            Self::Tcp(tcp) => tcp.exchange(unit, request, answer),
            Self::Serial(rtu) => rtu.exchange(unit, timeout, request, answer),
        }
    }
}
