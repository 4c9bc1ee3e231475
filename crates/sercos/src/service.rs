//! The service channel: six bytes each way, in which master and slave hand parameters to each other step by step.
//!
//! | | bits of the first two bytes | then |
//! |---|---|---|
//! | control, in the MDT | 0 MHS, 1 write, 2 last transmission, 5-3 element | four bytes |
//! | status, in the AT | 0 AHS, 1 busy, 2 error, 3 valid | four bytes |
//!
//! The master begins a step by changing MHS; the slave ends it by making AHS equal.

use crate::header::CommunicationPhase;
use crate::idn::{Attribute, Element, Idn, ValueShape, code};
use crate::parameters::{COMMAND_DONE, COMMAND_FAILED, SlaveParameters, VALUE, WireValue};
use crate::telegram::word;

const HANDSHAKE: u16 = 1;
const WRITE: u16 = 1 << 1;
const LAST: u16 = 1 << 2;
const BUSY: u16 = 1 << 1;
const ERROR: u16 = 1 << 2;
const VALID: u16 = 1 << 3;

/// The slave's side.
#[derive(Default)]
pub(crate) struct Server {
    ahs: bool,
    error: bool,
    info: u32,
    open: Option<usize>,
    element: u16,
    at: usize,
    buffer: [u8; VALUE + 4],
}

impl Server {
    /// Takes what the master sent. The same step twice, from both channels, is one step.
    pub(crate) fn take(
        &mut self,
        control: u16,
        info: u32,
        parameters: &mut SlaveParameters,
        phase: CommunicationPhase,
    ) {
        if (control & HANDSHAKE != 0) == self.ahs {
            return;
        }
        self.ahs = !self.ahs;
        let element = control >> 3 & 7;
        if element != self.element {
            (self.element, self.at) = (element, 0);
        }
        let answer = self.step(control, info, parameters, phase);
        self.error = answer.is_err();
        self.info = answer.unwrap_or_else(u32::from);
        if self.error || control & LAST != 0 {
            self.at = 0;
        }
    }

    /// Data of the slave: status and four bytes.
    pub(crate) fn give(&self) -> (u16, u32) {
        let bits = if self.error { ERROR } else { 0 };
        (u16::from(self.ahs) | bits | VALID, self.info)
    }

    fn step(
        &mut self,
        control: u16,
        info: u32,
        parameters: &mut SlaveParameters,
        phase: CommunicationPhase,
    ) -> Result<u32, u16> {
        let write = control & WRITE != 0;
        if self.element == Element::Close.number() {
            self.open = None;
            return Ok(0);
        }
        if self.element == Element::Idn.number() && write {
            self.open = parameters.find(Idn(info));
            return self.open.map(|_| info).ok_or(code::NO_IDN);
        }
        let open = self.open.ok_or(code::NOT_OPEN)?;
        match (self.element, write) {
            (1, false) => Ok(parameters.state(open).into()),
            (3, false) => Ok(parameters.attribute(open).0),
            (3, true) => Err(code::ATTRIBUTE_FIXED),
            (7, false) => self.read(parameters.value(open)),
            (7, true) => self.write(info, control & LAST != 0, open, parameters, phase),
            (element, _) => Err(element << 12 | 1),
        }
    }

    fn read(&mut self, value: WireValue) -> Result<u32, u16> {
        let bytes = value.bytes().get(self.at..).filter(|rest| !rest.is_empty()).ok_or(code::TOO_LONG)?;
        let mut four = [0; 4];
        for (place, byte) in four.iter_mut().zip(bytes) {
            *place = *byte;
        }
        self.at += 4;
        Ok(u32::from_le_bytes(four))
    }

    fn write(
        &mut self,
        info: u32,
        last: bool,
        open: usize,
        parameters: &mut SlaveParameters,
        phase: CommunicationPhase,
    ) -> Result<u32, u16> {
        let place = self.buffer.get_mut(self.at..self.at + 4).ok_or(code::TOO_LONG)?;
        place.copy_from_slice(&info.to_le_bytes());
        self.at += 4;
        if last {
            let short = parameters.attribute(open).shape() == Some(ValueShape::Word) && self.at == 4;
            let len = if short { 2 } else { self.at };
            parameters.write(open, &self.buffer[..len], phase)?;
        }
        Ok(0)
    }
}

/// Request of the master to a slave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ServiceRequest {
    /// The parameter has this value, or the slave is another one.
    Expect(Idn, WireValue),
    /// The parameter takes this value.
    Write(Idn, WireValue),
    /// The procedure command is executed.
    Execute(Idn),
}

impl ServiceRequest {
    /// The parameter.
    pub(crate) fn idn(&self) -> Idn {
        match *self {
            Self::Expect(idn, _) | Self::Write(idn, _) | Self::Execute(idn) => idn,
        }
    }
}

/// Failure of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServiceRefusal {
    /// The slave answered with this code.
    Code(u16),
    /// The parameter has another length than expected.
    Shape,
    /// The parameter has another value than expected.
    Value(WireValue),
    /// The procedure command ended with an error.
    Command,
    /// The slave did not end a step in time.
    Timeout,
}

/// Progress of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// Nothing is asked for.
    Idle,
    /// A step is under way.
    Busy,
    /// Done; told once.
    Done,
    /// Not done; told once.
    Refused(ServiceRefusal),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ServiceStep {
    None,
    Open,
    Attribute,
    Read,
    Write,
    Acknowledge,
    Clear,
}

/// The master's side.
pub(crate) struct ServiceClient {
    mhs: bool,
    control: u16,
    info: u32,
    request: Option<ServiceRequest>,
    step: ServiceStep,
    at: usize,
    buffer: [u8; VALUE + 4],
    waited: u32,
    patience: u32,
}

impl ServiceClient {
    /// A client that waits so many cycles for a step to end.
    pub(crate) fn new(patience: u32) -> Self {
        Self {
            mhs: false,
            control: 0,
            info: 0,
            request: None,
            step: ServiceStep::None,
            at: 0,
            buffer: [0; VALUE + 4],
            waited: 0,
            patience,
        }
    }

    /// Begins a request.
    pub(crate) fn ask(&mut self, request: ServiceRequest) {
        self.request = Some(request);
        (self.step, self.at) = (ServiceStep::Open, 0);
        self.send(Element::Idn, true, true, request.idn().0);
    }

    /// Data of the master: control and four bytes.
    pub(crate) fn give(&self) -> (u16, u32) {
        (self.control, self.info)
    }

    fn send(&mut self, element: Element, write: bool, last: bool, info: u32) {
        self.mhs = !self.mhs;
        self.waited = 0;
        self.control = u16::from(self.mhs)
            | if write { WRITE } else { 0 }
            | if last { LAST } else { 0 }
            | element.number() << 3;
        self.info = info;
    }

    /// Takes what the slave sent in this cycle, and goes on.
    pub(crate) fn take(&mut self, status: u16, info: u32) -> Progress {
        let Some(request) = self.request else {
            return Progress::Idle;
        };
        if status & VALID == 0 || (status & HANDSHAKE != 0) != self.mhs || status & BUSY != 0 {
            return self.wait();
        }
        if status & ERROR != 0 {
            return self.end(Err(ServiceRefusal::Code(info as u16)));
        }
        match self.next(request, info) {
            Ok(true) => self.end(Ok(())),
            Ok(false) => Progress::Busy,
            Err(refusal) => self.end(Err(refusal)),
        }
    }

    /// A cycle without an answer.
    pub(crate) fn wait(&mut self) -> Progress {
        if self.request.is_none() {
            return Progress::Idle;
        }
        self.waited += 1;
        if self.waited > self.patience { self.end(Err(ServiceRefusal::Timeout)) } else { Progress::Busy }
    }

    fn end(&mut self, how: Result<(), ServiceRefusal>) -> Progress {
        (self.request, self.step) = (None, ServiceStep::None);
        how.map_or_else(Progress::Refused, |()| Progress::Done)
    }

    /// The step after the one that ended; whether that was the last one.
    fn next(&mut self, request: ServiceRequest, info: u32) -> Result<bool, ServiceRefusal> {
        match (self.step, request) {
            (ServiceStep::None, _) => return Ok(true),
            (ServiceStep::Open, _) => {
                self.step = ServiceStep::Attribute;
                self.send(Element::Attribute, false, true, 0);
            }
            (ServiceStep::Attribute, _) => self.check_attribute(request, Attribute(info))?,
            (ServiceStep::Write, ServiceRequest::Execute(_)) => {
                self.step = ServiceStep::Acknowledge;
                self.send(Element::Idn, false, true, 0);
            }
            (ServiceStep::Write, ServiceRequest::Write(_, value)) => return Ok(self.write_more(value)),
            (ServiceStep::Read, ServiceRequest::Expect(_, value)) => return self.read_more(value, info),
            (ServiceStep::Acknowledge, _) => match info as u16 {
                COMMAND_DONE => {
                    self.step = ServiceStep::Clear;
                    self.send(Element::Data, true, true, 0);
                }
                COMMAND_FAILED => return Err(ServiceRefusal::Command),
                _ => {
                    let waited = self.waited;
                    self.send(Element::Idn, false, true, 0); // still at it: ask again
                    self.waited = waited + 1;
                    if self.waited > self.patience {
                        return Err(ServiceRefusal::Timeout);
                    }
                }
            },
            (ServiceStep::Clear, _) => return Ok(true),
            (ServiceStep::Write | ServiceStep::Read, _) => return Err(ServiceRefusal::Shape),
        }
        Ok(false)
    }

    /// The attribute is known: does the value fit?
    fn check_attribute(
        &mut self,
        request: ServiceRequest,
        attribute: Attribute,
    ) -> Result<(), ServiceRefusal> {
        let shape = match request {
            ServiceRequest::Expect(_, value) | ServiceRequest::Write(_, value) => value.shape(),
            ServiceRequest::Execute(_) => ValueShape::Word,
        };
        if attribute.shape() != Some(shape)
            || attribute.is_command() != matches!(request, ServiceRequest::Execute(_))
        {
            return Err(ServiceRefusal::Shape);
        }
        match request {
            ServiceRequest::Expect(_, value) => {
                self.step = ServiceStep::Read;
                self.send(Element::Data, false, value.bytes().len() <= 4, 0);
            }
            ServiceRequest::Write(_, value) => {
                self.step = ServiceStep::Write;
                self.write_more(value);
            }
            ServiceRequest::Execute(_) => {
                self.step = ServiceStep::Write;
                self.send(Element::Data, true, true, COMMAND_DONE.into());
            }
        }
        Ok(())
    }

    /// Sends the next four bytes of a value; whether all had been sent.
    fn write_more(&mut self, value: WireValue) -> bool {
        let bytes = value.bytes();
        if self.at >= bytes.len() {
            return true;
        }
        let info = u32::from(word(bytes, self.at)) | u32::from(word(bytes, self.at + 2)) << 16;
        self.at += 4;
        self.send(Element::Data, true, self.at >= bytes.len(), info);
        false
    }

    /// Takes four bytes of a value; whether it is whole and as expected.
    fn read_more(&mut self, value: WireValue, info: u32) -> Result<bool, ServiceRefusal> {
        let bytes = value.bytes();
        self.buffer[self.at..self.at + 4].copy_from_slice(&info.to_le_bytes());
        self.at += 4;
        if self.at < bytes.len() {
            self.send(Element::Data, false, self.at + 4 >= bytes.len(), 0);
            return Ok(false);
        }
        let found = &self.buffer[..bytes.len()];
        if found == bytes {
            return Ok(true);
        }
        Err(WireValue::received(found).map_or(ServiceRefusal::Shape, ServiceRefusal::Value))
    }
}
